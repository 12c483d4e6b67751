#include "umbridge/model.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "study/inputs.hpp"
#include "study/nearest.hpp"

namespace steerstat {
namespace {

std::string no_such_input(const std::string& name) {
  std::vector<std::string_view> known;
  for (const InputDefinition& definition : input_definitions()) known.push_back(definition.name);
  const std::optional<std::string_view> meant = nearest(name, known);
  return fmt::format("config.inputs: no input {}{}", quote(name),
                     meant ? fmt::format("; did you mean {}?", *meant) : "");
}

}  // namespace

std::vector<std::string> named_inputs(const Json& config, std::span<const std::string_view> defaults) {
  if (!config.contains("inputs")) return {defaults.begin(), defaults.end()};
  const Json& list = config["inputs"];
  if (!list.is_array() || list.empty()) {
    throw ModelRefusal(ModelRefusal::invalid_input, "config.inputs: expected an array of names, e.g. [\"plant.m1\"]");
  }
  std::vector<std::string> names;
  for (const Json& item : list) {
    const std::string name = item.is_string() ? item.get<std::string>() : item.dump();
    if (find_input(name) == nullptr) throw ModelRefusal(ModelRefusal::invalid_input, no_such_input(name));
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      throw ModelRefusal(ModelRefusal::invalid_input, fmt::format("config.inputs: {} is named twice", quote(name)));
    }
    names.push_back(name);
  }
  return names;
}

void require_known_keys(const Json& config, std::span<const std::string_view> known) {
  for (const auto& item : config.items()) {
    if (std::find(known.begin(), known.end(), item.key()) != known.end()) continue;
    throw ModelRefusal(ModelRefusal::invalid_input,
                       fmt::format("config: unknown key {} (known are {})", quote(item.key()), fmt::join(known, ", ")));
  }
}

void put(Json& spec, std::string_view dotted_name, double value) {
  Json* place = &spec;
  while (true) {
    const std::size_t dot = dotted_name.find('.');
    Json& below = (*place)[std::string(dotted_name.substr(0, dot))];
    if (dot == std::string_view::npos) {
      below = value;
      return;
    }
    place = &below;
    dotted_name.remove_prefix(dot + 1);
  }
}

}  // namespace steerstat
