#include <fmt/format.h>
#include <httplib.h>

#include <limits>

#include "api/documents_json.hpp"
#include "api/query.hpp"
#include "api/reply.hpp"
#include "api/routes.hpp"
#include "report/trajectory_json.hpp"
#include "study/parse_json.hpp"

namespace steerstat {
namespace {

constexpr std::uint64_t most_trials_a_page = 1000;
constexpr std::uint64_t usual_trials_a_page = 100;
constexpr std::uint64_t any = std::numeric_limits<std::uint64_t>::max();

TrialFilter filter_of(const httplib::Request& request) {
  TrialFilter filter;
  filter.cell = number_parameter(request, "cell", 0, any);
  if (const std::optional<std::string> status = parameter(request, "status")) {
    filter.status = status_named(*status);
    if (!filter.status) {
      throw Refused(
          {400,
           fmt::format("the query parameter status is {} (one of {})", quote(*status), fmt::join(status_names, ", ")),
           {},
           {}});
    }
  }
  return filter;
}

/// Nothing of a study under way, whose trials are in memory.
std::shared_ptr<void> place_to_read(Surroundings& surroundings, const StudyState& state) {
  return is_over(state.status) ? take_place(surroundings.readings, "readings of trials") : nullptr;
}

void list(Surroundings& surroundings, const Call& call, httplib::Response& response) {
  const StudyService& service = surroundings.service;
  expect_parameters(call.request, {"limit", "cursor", "status", "cell"});
  const std::string& id = id_of(call);
  const TrialFilter filter = filter_of(call.request);
  const auto limit = number_parameter(call.request, "limit", 1, most_trials_a_page).value_or(usual_trials_a_page);
  const auto begin = number_parameter(call.request, "cursor", 0, any).value_or(0);
  const StudyState state = state_of(service, id);
  if (has_already(call.request, response, tag_of(state.revision))) return;
  const auto place = place_to_read(surroundings, state);
  const TrialPage page = service.trials(id, filter, begin, limit);
  reply_json(response, trials_json(page), tag_of(page.revision));
}

/// A finished trial stays as it is, and the id says of which engine.
std::string tag_of_trial(const std::string& id, std::uint64_t index) {
  return fmt::format("\"{}-{}\"", id, index);
}

void show(Surroundings& surroundings, const Call& call, httplib::Response& response) {
  const StudyService& service = surroundings.service;
  expect_parameters(call.request, {});
  const std::string& id = id_of(call);
  const std::uint64_t index = trial_of(call);
  const auto place = place_to_read(surroundings, state_of(service, id));
  const TrialPage page = service.trial(id, index);
  if (has_already(call.request, response, tag_of_trial(id, index))) return;
  reply_json(response, trial_json(page), tag_of_trial(id, index));
}

void replay(Surroundings& surroundings, const Call& call, httplib::Response& response) {
  expect_parameters(call.request, {});
  const StudyService& service = surroundings.service;
  const std::string& id = id_of(call);
  const std::uint64_t index = trial_of(call);
  const auto place = take_place(surroundings.computations, computation);
  const std::string tag = tag_of_trial(id, index);
  // Whether it is there, before the client is told that it has it.
  if (!service.trial(id, index).rows.empty() && has_already(call.request, response, tag)) return;
  const ReplayedTrial trial = service.trajectory(id, index);
  reply_json(response, trajectory_json(*service.study(id), index, trial.names, trial.values, trial.trajectory), tag);
}

}  // namespace

std::uint64_t trial_of(const Call& call) {
  const std::optional<std::uint64_t> index = natural_number(call.values.at(1));
  if (!index)
    throw Refused({404, fmt::format("there is no trial {} (they are numbered from 0)", quote(call.values[1])), {}, {}});
  return *index;
}

void add_trial_routes(Router& router, Surroundings& surroundings) {
  router.add("GET", "/v1/studies/{id}/trials",
             [&](const Call& call, auto& response) { list(surroundings, call, response); });
  router.add("GET", "/v1/studies/{id}/trials/{index}",
             [&](const Call& call, auto& response) { show(surroundings, call, response); });
  router.add("GET", "/v1/studies/{id}/trials/{index}/trajectory",
             [&](const Call& call, auto& response) { replay(surroundings, call, response); });
}

}  // namespace steerstat
