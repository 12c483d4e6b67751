#include <fmt/format.h>
#include <httplib.h>

#include <optional>

#include "api/query.hpp"
#include "api/reply.hpp"
#include "api/routes.hpp"
#include "view/success_map.hpp"

namespace steerstat {
namespace {

void show_study(Surroundings& surroundings, const Call& call, httplib::Response& response) {
  expect_parameters(call.request, {});
  const std::string& id = id_of(call);
  const StudyState state = state_of(surroundings.service, id);
  // While a study runs its view may be older than its state.
  const std::string tag = is_over(state.status) ? tag_of(state.revision) : "";
  if (!tag.empty() && has_already(call.request, response, tag)) return;
  const auto place = take_place(surroundings.computations, computation);
  reply_json(response, *surroundings.service.study_view(id), tag);
}

/// A query parameter that must be there. @throws Refused 400
std::string axis_parameter(const httplib::Request& request, const std::string& name) {
  std::optional<std::string> input = parameter(request, name);
  if (!input) {
    throw Refused({400,
                   fmt::format("the query parameter {} is missing (the input along that axis); e.g. "
                               "?x=plant.m1&y=plant.f2",
                               name),
                   {},
                   {}});
  }
  return *std::move(input);
}

void show_map(Surroundings& surroundings, const Call& call, httplib::Response& response) {
  expect_parameters(call.request, {"x", "y"});
  const std::string& id = id_of(call);
  const std::string x = axis_parameter(call.request, "x");
  const std::string y = axis_parameter(call.request, "y");
  const StudyState state = state_of(surroundings.service, id);
  const std::string tag = is_over(state.status) ? fmt::format("\"{}-{}-{}\"", state.revision, x, y) : "";
  const auto place = take_place(surroundings.computations, computation);
  const std::string map = surroundings.service.success_map(id, x, y);  // whose axes exist, before it is in a header
  if (!tag.empty() && has_already(call.request, response, tag)) return;
  reply_json(response, map, tag);
}

void show_trial(Surroundings& surroundings, const Call& call, httplib::Response& response) {
  expect_parameters(call.request, {});
  const std::string& id = id_of(call);
  const std::uint64_t index = trial_of(call);
  const auto place = take_place(surroundings.computations, computation);
  reply_json(response, surroundings.service.trial_view(id, index));
}

}  // namespace

void add_view_routes(Router& router, Surroundings& surroundings) {
  router.add("GET", "/v1/studies/{id}/view",
             [&](const Call& call, auto& response) { show_study(surroundings, call, response); });
  router.add("GET", "/v1/studies/{id}/view/map",
             [&](const Call& call, auto& response) { show_map(surroundings, call, response); });
  router.add("GET", "/v1/studies/{id}/trials/{index}/view",
             [&](const Call& call, auto& response) { show_trial(surroundings, call, response); });
}

}  // namespace steerstat
