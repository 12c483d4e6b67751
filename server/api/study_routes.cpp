#include <fmt/format.h>
#include <httplib.h>

#include "api/documents_json.hpp"
#include "api/query.hpp"
#include "api/reply.hpp"
#include "api/routes.hpp"
#include "study/parse_json.hpp"

namespace steerstat {
namespace {

constexpr std::uint64_t most_studies_a_page = 100;
constexpr std::uint64_t usual_studies_a_page = 20;

/// Refuses with a 400 what is no JSON at all; what the document says is the service's to judge.
void check_syntax(const std::string& body) {
  try {
    std::vector<SpecError> duplicates;
    parse_json(body, duplicates);
  } catch (const BadSpec& bad) {
    throw Refused({400, "the body is no JSON that can be read", bad.errors(), {}});
  }
}

void submit(StudyService& service, const Call& call, httplib::Response& response) {
  expect_parameters(call.request, {});
  const std::string& spec = json_body(call.request);
  check_syntax(spec);
  std::optional<Submission> submission;
  try {
    submission = service.submit(spec);
  } catch (const RunFailure& failure) {  // most often a full disk
    throw Refused({503, failure.what(), {}, {{"Retry-After", "60"}}});
  }
  const StudyState& state = submission->state;
  response.set_header("Location", "/v1/studies/" + state.id);
  reply_json(response, state_json(state) + "\n", tag_of(state.revision), submission->created ? 201 : 200);
}

void list(const StudyService& service, const Call& call, httplib::Response& response) {
  expect_parameters(call.request, {"limit", "cursor"});
  const auto limit = number_parameter(call.request, "limit", 1, most_studies_a_page).value_or(usual_studies_a_page);
  const std::string cursor = parameter(call.request, "cursor").value_or("");
  reply_json(response, page_json(service.list(limit, cursor)));
}

void show_state(const StudyService& service, const Call& call, httplib::Response& response) {
  expect_parameters(call.request, {});
  const StudyState state = state_of(service, id_of(call));
  if (has_already(call.request, response, tag_of(state.revision))) return;
  reply_json(response, state_json(state) + "\n", tag_of(state.revision));
}

void show_summary(Surroundings& surroundings, const Call& call, httplib::Response& response) {
  expect_parameters(call.request, {});
  const std::string& id = id_of(call);
  const bool over = is_over(state_of(surroundings.service, id).status);
  const auto place = over ? nullptr : take_place(surroundings.summaries, "summaries of studies under way");
  const SummaryText summary = surroundings.service.summary(id);
  if (has_already(call.request, response, tag_of(summary.revision))) return;
  reply_json(response, summary.json, tag_of(summary.revision));
}

void show_spec(const StudyService& service, const Call& call, httplib::Response& response) {
  expect_parameters(call.request, {});
  const std::string& id = id_of(call);
  const std::string spec = service.spec(id);
  const std::string tag = "\"" + id + "\"";  // the id is the spec's
  if (has_already(call.request, response, tag)) return;
  reply_json(response, spec + "\n", tag);
}

void cancel_or_remove(StudyService& service, const Call& call, httplib::Response& response) {
  expect_parameters(call.request, {});
  std::optional<StudyService::Removal> removal;
  try {
    removal = service.cancel_or_remove(id_of(call));
  } catch (const RunFailure& failure) {
    throw Refused({503, failure.what(), {}, {{"Retry-After", "60"}}});
  }
  if (removal->removed) {
    response.status = 204;
    return;
  }
  const StudyState& state = removal->state;
  reply_json(response, state_json(state) + "\n", tag_of(state.revision), is_over(state.status) ? 200 : 202);
}

}  // namespace

void add_study_routes(Router& router, Surroundings& surroundings) {
  StudyService& service = surroundings.service;
  router.add("POST", "/v1/studies", [&](const Call& call, auto& response) { submit(service, call, response); });
  router.add("GET", "/v1/studies", [&](const Call& call, auto& response) { list(service, call, response); });
  router.add("GET", "/v1/studies/{id}", [&](const Call& call, auto& response) { show_state(service, call, response); });
  router.add("DELETE", "/v1/studies/{id}",
             [&](const Call& call, auto& response) { cancel_or_remove(service, call, response); });
  router.add("GET", "/v1/studies/{id}/summary",
             [&](const Call& call, auto& response) { show_summary(surroundings, call, response); });
  router.add("GET", "/v1/studies/{id}/spec",
             [&](const Call& call, auto& response) { show_spec(service, call, response); });
}

}  // namespace steerstat
