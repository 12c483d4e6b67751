#include "study/input_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "study/distribution_json.hpp"
#include "study/limits.hpp"

namespace steerstat {
namespace {

bool has_nominal_value(const InputDefinition& definition) {
  return definition.name.starts_with("plant.") && !definition.is_imperfection;
}

std::string values_rule(const InputDefinition& definition) {
  return fmt::format("{} {}", definition.name, definition.range.rule);
}

// What a distribution that draws impossible values is best replaced with.
std::string advice_for(const Distribution::Shape& shape) {
  if (std::holds_alternative<Normal>(shape)) return "use a truncated_normal with possible bounds";
  if (std::holds_alternative<Lognormal>(shape)) return "use a distribution with an upper bound, such as triangular";
  return "narrow it";
}

bool require_possible_values(const InputDefinition& definition, const Distribution& distribution, double scale,
                             const Reader& shape) {
  if (const auto* discrete = std::get_if<Discrete>(&distribution.shape)) {
    for (const double value : discrete->values()) {
      if (definition.range.contains(scale * value)) continue;
      shape.fail(fmt::format("the value {} is impossible ({}); replace it", scale * value, values_rule(definition)));
      return false;
    }
    return true;
  }
  Support support = distribution.support();
  support.low *= scale;
  support.high *= scale;
  if (scale < 0.0) std::swap(support.low, support.high);
  if (!definition.range.contains(support)) {
    shape.fail(fmt::format("draws from {} to {} would include impossible values ({}); {}", support.low, support.high,
                           values_rule(definition), advice_for(distribution.shape)));
    return false;
  }
  for (const double u : {0x1p-53, 1.0 - 0x1p-53}) {  // the extreme draws
    if (definition.range.contains(scale * distribution.quantile(u))) continue;
    shape.fail(fmt::format("draws would leave the range of a double ({}); narrow it", values_rule(definition)));
    return false;
  }
  return true;
}

// The factor between a distribution's draws and the input's values.
std::optional<double> scale_of(const InputDefinition& definition, std::optional<double> nominal, const Reader& reader) {
  const auto relative = reader.find("relative");
  if (!relative) return 1.0;
  if (!has_nominal_value(definition)) {
    relative->fail(
        "only plant values that the controller has a nominal value of can be relative (they multiply it); give "
        "absolute values");
    return std::nullopt;
  }
  const auto is_relative = relative->boolean();
  if (!is_relative || (*is_relative && !nominal)) return std::nullopt;
  if (*is_relative && *nominal == 0.0) {
    relative->fail(
        fmt::format("the nominal value of {} is 0, so every draw would be 0 (relative multiplies the nominal "
                    "value); give absolute values",
                    definition.name));
    return std::nullopt;
  }
  return *is_relative ? *nominal : 1.0;
}

std::optional<InputValue> decode_distribution(const InputDefinition& definition, std::optional<double> nominal,
                                              std::string_view name, const Reader& reader) {
  const Reader shape_reader = *reader.find(name);
  auto shape = decode_shape(name, shape_reader);
  const auto scale = scale_of(definition, nominal, reader);
  if (!shape || !scale) return std::nullopt;
  const auto relative = reader.find("relative");
  Distribution distribution{*std::move(shape), relative && relative->value().get<bool>()};
  if (!require_possible_values(definition, distribution, *scale, shape_reader)) return std::nullopt;
  return distribution;
}

std::optional<InputValue> decode_sweep(const InputDefinition& definition, const Reader& reader) {
  if (!reader.require_array("an array of numbers")) return std::nullopt;
  const std::size_t size = reader.value().size();
  if (size == 0) {
    reader.fail("the sweep is empty (at least 1 value); list the values to try");
    return std::nullopt;
  }
  if (size > most_cells) {
    reader.fail(fmt::format("{} values make too many cells (at most {}); sweep fewer", size, most_cells));
    return std::nullopt;
  }
  Sweep sweep;
  sweep.values.reserve(size);
  std::set<double> seen;
  for (std::size_t i = 0; i < size; ++i) {
    const Reader element = reader.element(i);
    const auto x = element.number_in(definition.range, definition.name);
    if (!x) continue;
    if (!seen.insert(*x).second) {
      element.fail(fmt::format("{} is in the sweep already (values differ); remove it", *x));
      continue;
    }
    sweep.values.push_back(*x);
  }
  if (sweep.values.size() != size) return std::nullopt;
  return sweep;
}

std::optional<InputValue> decode_object(const InputDefinition& definition, std::optional<double> nominal,
                                        const Reader& reader) {
  std::vector<std::string_view> known(distribution_names.begin(), distribution_names.end());
  known.emplace_back("sweep");
  std::vector<std::string_view> kinds;
  for (const std::string_view kind : known) {
    if (reader.find(kind)) kinds.push_back(kind);
  }
  if (kinds.size() > 1) {
    reader.fail(fmt::format("{} in one place (a number has one of them); keep one", listed(kinds)));
    return std::nullopt;
  }
  const bool sweeps = !kinds.empty() && kinds.front() == "sweep";
  static constexpr std::array<std::string_view, 1> relative{"relative"};
  const std::size_t mistakes = reader.errors().size();
  reader.refuse_unknown_keys(known, relative);
  if (kinds.empty()) {
    if (reader.errors().size() == mistakes) {
      reader.fail(
          fmt::format("no distribution and no sweep here (one of {}); add one, or give a number", listed(known)));
    }
    return std::nullopt;
  }
  if (sweeps) {
    if (const auto flag = reader.find("relative")) {
      flag->fail("a sweep is not relative (only distributions are); sweep absolute values, and remove this");
    }
    return decode_sweep(definition, *reader.find("sweep"));
  }
  return decode_distribution(definition, nominal, kinds.front(), reader);
}

}  // namespace

std::optional<InputValue> decode_input(const InputDefinition& definition, std::optional<double> nominal,
                                       const Reader& reader) {
  if (reader.value().is_object()) return decode_object(definition, nominal, reader);
  if (reader.value().is_array()) {
    reader.fail(
        "an array is not a number, a distribution or a sweep; write {\"sweep\": [...]} or {\"uniform\": [low, "
        "high]}");
    return std::nullopt;
  }
  return reader.number_in(definition.range, definition.name);
}

nlohmann::json encode_input(const InputValue& value) {
  if (const auto* sweep = std::get_if<Sweep>(&value)) {
    nlohmann::json object;
    object["sweep"] = sweep->values;
    return object;
  }
  if (const auto* distribution = std::get_if<Distribution>(&value)) return encode_distribution(*distribution);
  return std::get<double>(value);
}

}  // namespace steerstat
