#include "api/documents_json.hpp"

#include <nlohmann/json.hpp>
#include <optional>

#include "report/trajectory_json.hpp"

namespace steerstat {
namespace {

using Json = nlohmann::ordered_json;

template <class Value>
Json or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}

Json json_of(const StudyState& state) {
  return {{"id", state.id},
          {"name", state.name},
          {"status", name_of(state.status)},
          {"progress",
           {{"completed", state.completed},
            {"requested", state.requested},
            {"trials_per_s", or_null(state.trials_per_s)},
            {"eta_s", or_null(state.eta_s)}}},
          {"created", state.created},
          {"started", or_null(state.started)},
          {"finished", or_null(state.finished)},
          {"failure", or_null(state.failure)}};
}

Json json_of(const std::vector<std::string>& names, const TrialRow& row) {
  Json parameters = Json::object();
  for (std::size_t i = 0; i < names.size(); ++i) parameters[names[i]] = row.values[i];
  return {{"index", row.index},
          {"cell", row.cell},
          {"parameters", std::move(parameters)},
          {"outcome", outcome_json(row.outcome)}};
}

}  // namespace

std::string state_json(const StudyState& state) {
  return json_of(state).dump();
}

std::string page_json(const StudyPage& page) {
  Json studies = Json::array();
  for (const StudyState& state : page.studies) studies.push_back(json_of(state));
  return Json{{"studies", std::move(studies)}, {"next", or_null(page.next)}}.dump() + "\n";
}

std::string trials_json(const TrialPage& page) {
  Json trials = Json::array();
  for (const TrialRow& row : page.rows) trials.push_back(json_of(page.names, row));
  return Json{{"trials", std::move(trials)}, {"next", or_null(page.next)}}.dump() + "\n";
}

std::string trial_json(const TrialPage& page) {
  return json_of(page.names, page.rows.front()).dump() + "\n";
}

}  // namespace steerstat
