#include "umbridge/models.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/errors.hpp"

namespace steerstat {
namespace {

constexpr std::array<std::string_view, 3> derivatives{"Gradient", "ApplyJacobian", "ApplyHessian"};

Json parsed(std::string_view body) {
  std::vector<SpecError> duplicates;
  try {
    Json request = parse_json(body, duplicates);
    if (!duplicates.empty()) throw BadSpec(duplicates);
    if (!request.is_object()) throw ModelRefusal(ModelRefusal::invalid_input, "the request is not a JSON object");
    return request;
  } catch (const BadSpec& bad) {
    throw ModelRefusal(ModelRefusal::invalid_input, bad.what());
  }
}

Json config_of(const Json& request) {
  Json config = request.value("config", Json::object());
  // R writes an empty list so.
  if (config.is_null() || (config.is_array() && config.empty())) return Json::object();
  if (!config.is_object()) throw ModelRefusal(ModelRefusal::invalid_input, "config: expected an object");
  return config;
}

/// The only input vector of a request.
std::vector<double> input_of(const Json& request, std::size_t size) {
  const Json input = request.value("input", Json());
  if (!input.is_array() || input.size() != 1 || !input[0].is_array()) {
    throw ModelRefusal(ModelRefusal::invalid_input, "input: expected one vector, [[x, ...]]");
  }
  if (input[0].size() != size) {
    throw ModelRefusal(ModelRefusal::invalid_input,
                       fmt::format("input: a vector of {}, where the model takes {}", input[0].size(), size));
  }
  std::vector<double> values;
  for (const Json& value : input[0]) {
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      throw ModelRefusal(ModelRefusal::invalid_input, fmt::format("input: {} is no finite number", value.dump()));
    }
    values.push_back(value.get<double>());
  }
  return values;
}

}  // namespace

std::string Models::info() {
  return R"({"protocolVersion":1.0,"models":["trial","study"]})";
}

const Model& Models::model(const Json& request) const {
  const Json given = request.value("name", Json());
  const std::string name = given.is_string() ? given.get<std::string>() : given.dump();
  if (name == trial_.name()) return trial_;
  if (name == study_.name()) return study_;
  throw ModelRefusal(ModelRefusal::not_found, fmt::format("no model {}; there are trial and study", quote(name)));
}

Json Models::result_of(std::string_view action, const Json& request) const {
  const Model& asked = model(request);
  for (const std::string_view derivative : derivatives) {
    if (action != derivative) continue;
    throw ModelRefusal(ModelRefusal::unsupported, fmt::format("the model {} has no derivatives", asked.name()));
  }
  if (action == "ModelInfo") {
    return {{"support", {{"Evaluate", true}, {"Gradient", false}, {"ApplyJacobian", false}, {"ApplyHessian", false}}}};
  }
  if (action == "OutputSizes") return {{"outputSizes", Json::array({asked.outputs()})}};
  const Json config = config_of(request);
  const std::size_t size = asked.inputs(config);
  if (action == "InputSizes") return {{"inputSizes", Json::array({size})}};
  return {{"output", Json::array({asked.evaluate(input_of(request, size), config)})}};
}

ModelReply Models::answer(std::string_view action, std::string_view body) const {
  try {
    return {200, result_of(action, parsed(body)).dump()};
  } catch (const ModelRefusal& refusal) {
    return reply_of(refusal);
  }
}

ModelReply reply_of(const ModelRefusal& refusal, int status) {
  const Json error{{"error", {{"type", refusal.type()}, {"message", refusal.what()}}}};
  return {status, error.dump()};
}

}  // namespace steerstat
