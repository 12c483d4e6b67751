#include <nlohmann/json.hpp>

#include "report/number_json.hpp"
#include "report/rare_failures_json.hpp"
#include "report/sensitivity_json.hpp"
#include "report/summary.hpp"
#include "trial/metric.hpp"

namespace steerstat {
namespace {

using Json = nlohmann::ordered_json;  // keys in the order of the interface's description

/// @param method  the interval's
Json success_rate_json(const TrialStatistics& statistics, double level, std::string_view method) {
  const std::optional<ProportionInterval>& rate = statistics.success_rate;
  Json json = {{"estimate", nullptr}, {"ci_low", nullptr}, {"ci_high", nullptr}};
  if (rate) json = {{"estimate", rate->estimate}, {"ci_low", rate->low}, {"ci_high", rate->high}};
  json["level"] = level;
  json["method"] = method;
  json["unit"] = interval_unit_names[static_cast<std::size_t>(statistics.unit)];
  json["effective_trials"] =
      rate && statistics.unit != IntervalUnit::none ? Json(statistics.effective_trials) : Json(nullptr);
  return json;
}

Json outcomes_json(const TrialStatistics& statistics) {
  Json json = Json::object();
  for (std::size_t i = 0; i < status_names.size(); ++i) json[std::string(status_names[i])] = statistics.outcomes[i];
  return json;
}

Json sample_json(const std::optional<SampleStatistics>& sample) {
  const auto value = [&](double SampleStatistics::*member) { return sample ? Json((*sample).*member) : Json(nullptr); };
  return {{"mean", value(&SampleStatistics::mean)}, {"std", number_or_null(sample ? sample->std : std::nullopt)},
          {"min", value(&SampleStatistics::min)},   {"p05", value(&SampleStatistics::p05)},
          {"p50", value(&SampleStatistics::p50)},   {"p95", value(&SampleStatistics::p95)},
          {"p99", value(&SampleStatistics::p99)},   {"max", value(&SampleStatistics::max)},
          {"count", sample ? sample->count : 0}};
}

void append_statistics(Json& json, std::uint64_t requested, std::uint64_t completed, const Summary& summary,
                       const TrialStatistics& statistics) {
  const auto& [usual, level] = summary.intervals;
  const std::string_view method = summary.rare_failures ? interval_method(*summary.rare_failures)
                                                        : proportion_method_names[static_cast<std::size_t>(usual)];
  json["trials"] = {{"requested", requested}, {"completed", completed}};
  json["success_rate"] = success_rate_json(statistics, level, method);
  json["outcomes"] = outcomes_json(statistics);
  for (std::size_t i = 0; i < metric_count; ++i) {
    json[std::string(metrics()[i].name)] = sample_json(statistics.metrics[i]);
  }
}

/// By name; null for no sweep.
Json sweep_json(const std::vector<Plan::SweptValue>& sweep) {
  Json json;
  for (const Plan::SweptValue& swept : sweep) json[swept.name] = swept.value;
  return json;
}

Json cells_json(const Summary& summary) {
  Json cells = Json::array();
  for (const Summary::Cell& cell : summary.cells) {
    Json json;
    json["sweep"] = sweep_json(cell.sweep);
    append_statistics(json, summary.requested / summary.cells.size(), cell.statistics.completed, summary,
                      cell.statistics);
    cells.push_back(std::move(json));
  }
  return cells;
}

Json goal_json(const PrecisionGoal& goal, const GoalProgress& progress, bool has_cells) {
  Json json = {{"metric", goal.metric}, {"quantile", number_or_null(goal.quantile)}};
  json[goal.relative ? "relative_half_width" : "half_width"] = goal.half_width;
  json["reached"] = progress.reached;
  json["cell"] = has_cells ? Json(progress.cell) : Json(nullptr);
  json["estimate"] = number_or_null(progress.estimate);
  json["ci_low"] = number_or_null(progress.low);
  json["ci_high"] = number_or_null(progress.high);
  return json;
}

Json stop_json(const Summary& summary) {
  if (!summary.stop) return nullptr;
  const auto& [rule, report] = *summary.stop;
  Json json;
  json["reason"] = report.reason ? Json(stop_reason_names[static_cast<std::size_t>(*report.reason)]) : Json(nullptr);
  json["trials"] = report.trials;
  json["looks"] = report.looks;
  json["level"] = rule.level;
  json["until"] = Json::array();
  for (std::size_t i = 0; i < rule.until.size(); ++i) {
    json["until"].push_back(goal_json(rule.until[i], report.goals[i], !summary.cells.empty()));
  }
  return json;
}

Json gates_json(const std::vector<GateVerdict>& gates) {
  Json array = Json::array();
  for (const GateVerdict& gate : gates) {
    array.push_back({{"metric", gate.metric},
                     {"expr", gate.expr},
                     {"cell", sweep_json(gate.cell)},
                     {"value", number_or_null(gate.value)},
                     {"ci_low", number_or_null(gate.interval.low)},
                     {"ci_high", number_or_null(gate.interval.high)},
                     {"verdict", name_of(gate.verdict)},
                     {"reason", gate.reason}});
  }
  return array;
}

Json drop_json(const std::optional<ProportionDrop>& drop) {
  if (!drop) return nullptr;
  return {{"estimate", drop->estimate}, {"low", drop->low}, {"high", drop->high}};
}

Json baseline_json(const std::optional<BaselineComparison>& baseline) {
  if (!baseline) return nullptr;
  Json json = {{"id", baseline->id},
               {"name", baseline->name},
               {"engine_version", baseline->engine_version},
               {"seed", baseline->seed},
               {"trials", baseline->converged.trials},
               {"converged", baseline->converged.successes},
               {"level", baseline->test.level},
               {"power", baseline->test.power},
               {"margin", baseline->test.margin},
               {"drop", drop_json(baseline->drop)},
               {"detectable_drop", number_or_null(baseline->detectable_drop)},
               {"cells", Json::array()}};
  for (const BaselineComparison::Cell& cell : baseline->cells) {
    json["cells"].push_back({{"sweep", sweep_json(cell.sweep)},
                             {"trials", cell.converged.trials},
                             {"converged", cell.converged.successes},
                             {"drop", drop_json(cell.drop)},
                             {"detectable_drop", number_or_null(cell.detectable_drop)}});
  }
  return json;
}

Json audit_json(const std::optional<AuditStatistics>& audit) {
  if (!audit) return nullptr;
  Json json = {{"trials", audit->trials}, {"agree", audit->agree}, {"disagree", audit->disagree}};
  json["settling_time_difference"] = nullptr;
  if (const auto& difference = audit->settling_time_difference) {
    json["settling_time_difference"] = {
        {"median", difference->median}, {"p99", difference->p99}, {"max", difference->max}};
  }
  json["tolerance"] = audit->tolerance;
  return json;
}

Json performance_json(const Summary& summary) {
  Json json = {{"wall_s", summary.wall_s}, {"trials_per_s", nullptr}, {"threads", summary.threads}};
  json["simd"] = summary.simd ? Json(name_of(*summary.simd)) : Json(nullptr);
  if (summary.completed > 0 && summary.wall_s > 0.0) {
    json["trials_per_s"] = static_cast<double>(summary.completed) / summary.wall_s;
  }
  return json;
}

}  // namespace

std::string summary_json(const Summary& summary) {
  Json json;
  json["study"] = {{"id", summary.id},
                   {"name", summary.name},
                   {"spec_sha256", summary.spec_sha256},
                   {"population_sha256", summary.population_sha256},
                   {"engine_version", summary.engine_version},
                   {"seed", summary.seed}};
  json["complete"] = summary.complete;
  append_statistics(json, summary.requested, summary.completed, summary, summary.all);
  json["stop"] = stop_json(summary);
  json["cells"] = cells_json(summary);
  json["sensitivity"] = sobol_json(summary.sensitivity);
  json["rare_failures"] = rare_failures_json(summary.rare_failures);
  json["gates"] = gates_json(summary.gates);
  json["baseline"] = baseline_json(summary.baseline);
  json["audit"] = audit_json(summary.audit);
  // In the summary of a study that keeps all rows, as all did before there was a choice, there is nothing to say.
  if (summary.store != Store::all) {
    json["sketch"] = {{"store", store_names[static_cast<std::size_t>(summary.store)]},
                      {"relative_error", QuantileSketch::relative_error}};
  }
  json["performance"] = performance_json(summary);
  // A name is the user's: were it not UTF-8, it must not cost the summary.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace steerstat
