#include <array>

#include "report/sensitivity.hpp"
#include "study/input_json.hpp"
#include "view/columns_json.hpp"
#include "view/study_view.hpp"

namespace steerstat {
namespace {

using view_json::Json;

constexpr std::array<std::string_view, 3> source_names{"drawn", "swept", "listed"};

/// The summary, whose cells stand elsewhere.
Json summary_of(const Summary& summary, const std::optional<std::string>& kept) {
  if (kept) return Json::parse(*kept);
  Summary without_cells = summary;
  without_cells.cells.clear();
  return Json::parse(summary_json(without_cells));
}

Json narrowing_json(const Narrowing& narrowing) {
  return {{"of", narrowing.of},
          {"level", narrowing.intervals.level},
          {"method", proportion_method_names[static_cast<std::size_t>(narrowing.intervals.method)]},
          {"at_once", narrowing.intervals.method == ProportionMethod::confidence_sequence},
          {"trials", narrowing.trials},
          {"estimate", view_json::numbers(narrowing.estimate)},
          {"low", view_json::numbers(narrowing.low)},
          {"high", view_json::numbers(narrowing.high)}};
}

Json input_json(const StudyView::VaryingInputView& input) {
  const bool listed = input.source == StudyView::VaryingInputView::Source::listed;
  return {{"input", input.input},
          {"unit", input.unit},
          {"source", source_names[static_cast<std::size_t>(input.source)]},
          {"spec", listed ? Json(nullptr) : Json(encode_input(input.value).dump())},
          {"low", view_json::number_or_null(input.low)},
          {"high", view_json::number_or_null(input.high)}};
}

Json marginal_json(const Marginal& marginal, double level) {
  Json low = Json::array();
  Json high = Json::array();
  for (const auto& interval : marginal.intervals) {
    low.push_back(interval ? view_json::number(interval->low) : Json(nullptr));
    high.push_back(interval ? view_json::number(interval->high) : Json(nullptr));
  }
  return {{"axis", view_json::axis(marginal.axis)},
          {"outside", marginal.counts.outside},
          {"trials", marginal.counts.trials},
          {"successes", marginal.counts.successes},
          {"level", level},
          {"low", std::move(low)},
          {"high", std::move(high)}};
}

Json cells_json(const std::vector<Summary::Cell>& cells) {
  if (cells.size() > most_listed_cells) return nullptr;
  Json trials = Json::array(), successes = Json::array(), low = Json::array(), high = Json::array(),
       settling_time = Json::array();
  for (const Summary::Cell& cell : cells) {
    const TrialStatistics& statistics = cell.statistics;
    const auto& rate = statistics.success_rate;
    const auto& times = statistics.of("settling_time");
    trials.push_back(statistics.completed);
    successes.push_back(statistics.outcomes[static_cast<std::size_t>(Status::converged)]);
    low.push_back(rate ? view_json::number(rate->low) : Json(nullptr));
    high.push_back(rate ? view_json::number(rate->high) : Json(nullptr));
    settling_time.push_back(times ? view_json::number(times->p50) : Json(nullptr));
  }
  return {{"trials", std::move(trials)},
          {"successes", std::move(successes)},
          {"low", std::move(low)},
          {"high", std::move(high)},
          {"settling_time", std::move(settling_time)}};
}

Json sweeps_json(const StudyView& view, const Summary& summary) {
  if (view.sweeps.empty()) return nullptr;
  Json axes = Json::array();
  for (const StudyView::SweptAxis& axis : view.sweeps) {
    axes.push_back({{"input", axis.input}, {"unit", axis.unit}, {"values", axis.values}});
  }
  return {{"axes", std::move(axes)}, {"level", summary.intervals.level}, {"cells", cells_json(summary.cells)}};
}

Json sensitivity_of(const StudyView& view, const Summary& summary) {
  SensitivityReport report;
  report.given_data = view.given_data;
  report.sobol = summary.sensitivity;
  const Json json = Json::parse(sensitivity_json(report));
  return {{"of", view.sensitivity_of}, {"given_data", json["given_data"]}, {"sobol_indices", json["sobol_indices"]}};
}

Json sample_json(const StudyView::Sample& sample) {
  Json inputs = Json::array();
  for (const std::vector<double>& column : sample.inputs) inputs.push_back(view_json::numbers(column));
  return {{"of", sample.of},
          {"index", sample.index},
          {"status", view_json::statuses(sample.status)},
          {"settling_time", view_json::numbers(sample.settling_time)},
          {"inputs", std::move(inputs)}};
}

Json failed_json(const StudyView::Failures& failed) {
  return {{"of", failed.of},
          {"index", failed.index},
          {"status", view_json::statuses(failed.status)},
          {"end_time", view_json::numbers(failed.end_time)}};
}

template <class List, class Encode>
Json list_json(const List& list, const Encode& encode) {
  Json json = Json::array();
  for (const auto& element : list) json.push_back(encode(element));
  return json;
}

}  // namespace

std::string study_view_json(const StudyView& view, const Summary& summary,
                            const std::optional<std::string>& kept_summary) {
  const StudyView::CycleCounts& cycles = view.cycles;
  Json json;
  json["view"] = "study";
  json["version"] = view_version;
  json["created"] = view.created ? Json(*view.created) : Json(nullptr);
  json["spec"] = view.spec;
  json["rows"] = shown_rows_names[static_cast<std::size_t>(view.rows)];
  json["trials"] = {{"requested", summary.requested}, {"finished", summary.completed}, {"used", view.used}};
  json["summary"] = summary_of(summary, kept_summary);
  json["narrowing"] = narrowing_json(view.narrowing);
  json["distributions"] = list_json(view.distributions, view_json::distribution);
  json["cycles"] = {
      {"from", cycles.from}, {"to", cycles.to}, {"converged", cycles.converged}, {"others", cycles.others}};
  json["inputs"] = list_json(view.inputs, input_json);
  json["marginals"] = list_json(
      view.marginals, [&](const Marginal& marginal) { return marginal_json(marginal, summary.intervals.level); });
  json["sweeps"] = sweeps_json(view, summary);
  json["sensitivity"] = view.rows == ShownRows::all ? sensitivity_of(view, summary) : Json(nullptr);
  json["sample"] = sample_json(view.sample);
  json["failed"] = failed_json(view.failed);
  json["maps"] = list_json(view.maps, view_json::success_map);
  return view_json::text(json);
}

}  // namespace steerstat
