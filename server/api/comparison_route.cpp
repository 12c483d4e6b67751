#include <fmt/format.h>
#include <httplib.h>

#include <nlohmann/json.hpp>

#include "api/query.hpp"
#include "api/reply.hpp"
#include "api/routes.hpp"
#include "report/comparison.hpp"
#include "study/parse_json.hpp"

namespace steerstat {
namespace {

Json parsed(const std::string& body, std::vector<SpecError>& errors) {
  try {
    return parse_json(body, errors);
  } catch (const BadSpec& bad) {
    throw Refused({400, "the body is no JSON that can be read", bad.errors(), {}});
  }
}

/// The ids `{"a": ID, "b": ID}`. @throws BadSpec with every mistake
std::pair<std::string, std::string> ids_of(const StudyService& service, const std::string& body) {
  std::vector<SpecError> errors;
  const Json document = parsed(body, errors);
  if (!document.is_object()) {
    throw BadSpec(std::vector<SpecError>{{"", R"(the document is no object; send {"a": ID, "b": ID})"}});
  }
  const auto id = [&](const std::string& key) -> std::string {
    const std::string place = fmt::format("/{}", key);
    const auto found = document.find(key);
    if (found == document.end() || !found->is_string()) {
      errors.push_back({found == document.end() ? "" : place, key + " is not the id of a study; give both a and b"});
      return "";
    }
    std::string value = found->get<std::string>();
    if (!service.state(value)) errors.push_back({place, "there is no study " + quote(value)});
    return value;
  };
  std::pair<std::string, std::string> ids{id("a"), id("b")};
  for (const auto& [key, value] : document.items()) {
    if (key != "a" && key != "b")
      errors.push_back({fmt::format("/{}", pointer_token(key)), "unknown key; known are a and b"});
  }
  if (!errors.empty()) throw BadSpec(std::move(errors));
  return ids;
}

}  // namespace

void add_comparison_route(Router& router, Surroundings& surroundings) {
  router.add("POST", "/v1/comparisons", [&surroundings](const Call& call, httplib::Response& response) {
    expect_parameters(call.request, {});
    const auto [a, b] = ids_of(surroundings.service, json_body(call.request));
    const auto place = take_place(surroundings.computations, computation);
    reply_json(response, comparison_json(surroundings.service.compare(a, b)));
  });
  router.add("POST", "/v1/comparisons/view", [&surroundings](const Call& call, httplib::Response& response) {
    expect_parameters(call.request, {});
    const auto [a, b] = ids_of(surroundings.service, json_body(call.request));
    const auto place = take_place(surroundings.computations, computation);
    reply_json(response, surroundings.service.comparison_view(a, b));
  });
}

}  // namespace steerstat
