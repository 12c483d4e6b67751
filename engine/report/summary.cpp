#include "report/summary.hpp"

#include <algorithm>
#include <cmath>

#include "core/version.hpp"
#include "report/gates.hpp"
#include "report/independence.hpp"
#include "report/readable.hpp"
#include "study/plan.hpp"
#include "study/spec_json.hpp"
#include "study/watched.hpp"
#include "trial/metric.hpp"

namespace steerstat {
namespace {

/// All but the metrics.
TrialStatistics statistics_of_outcomes(const std::array<std::uint64_t, status_names.size()>& outcomes,
                                       const Independence& independence, bool in_cell) {
  TrialStatistics result;
  result.outcomes = outcomes;
  for (const std::uint64_t count : outcomes) result.completed += count;
  result.unit = independence.unit(in_cell);
  result.success_rate = independence.rate(Status::converged, result, in_cell);
  result.effective_trials = independence.effective_trials(result, in_cell);
  return result;
}

/// What of the trials the statistics are made from.
struct Tally {
  std::array<std::uint64_t, status_names.size()> outcomes{};
  std::array<std::vector<double>, metric_count> samples{};  // (metrics) of the trials that have it

  void add(const TrialOutcome& outcome) {
    ++outcomes[static_cast<std::size_t>(outcome.status)];
    for (std::size_t i = 0; i < metric_count; ++i) {
      if (const double value = metrics()[i].value(outcome); !std::isnan(value)) samples[i].push_back(value);
    }
  }

  [[nodiscard]] TrialStatistics statistics(const Independence& independence, bool in_cell) const {
    TrialStatistics result = statistics_of_outcomes(outcomes, independence, in_cell);
    for (std::size_t i = 0; i < metric_count; ++i) result.metrics[i] = describe(samples[i]);
    return result;
  }
};

std::optional<SampleStatistics> sketch_statistics(const MetricSketch& sketch) {
  const Moments& moments = sketch.moments;
  if (moments.count() == 0) return std::nullopt;
  const SketchedOrder order(sketch.quantiles);
  const auto quantile = [&](double p) { return std::clamp(order.quantile(p), moments.min(), moments.max()); };
  return SampleStatistics{moments.mean(), moments.standard_deviation(),
                          moments.min(),  quantile(0.05),
                          quantile(0.50), quantile(0.95),
                          quantile(0.99), moments.max(),
                          moments.count()};
}

TrialStatistics statistics_of(const TrialSketch::Cell& cell, const Independence& independence, bool in_cell) {
  TrialStatistics result = statistics_of_outcomes(cell.outcomes, independence, in_cell);
  for (std::size_t i = 0; i < metric_count; ++i) result.metrics[i] = sketch_statistics(cell.metrics[i]);
  return result;
}

/// The statistics of a study that does not keep all rows.
void summarise_sketch(const TrialSketch& sketch, const Plan& plan, const Independence& independence, Summary& summary) {
  TrialSketch::Cell all;
  for (const TrialSketch::Cell& cell : sketch.cells()) {
    for (std::size_t i = 0; i < all.outcomes.size(); ++i) all.outcomes[i] += cell.outcomes[i];
    for (std::size_t i = 0; i < metric_count; ++i) all.metrics[i].add(cell.metrics[i]);
  }
  summary.all = statistics_of(all, independence, false);
  if (plan.sweep_values(0).empty()) return;
  for (std::uint64_t cell = 0; cell < plan.cells(); ++cell) {
    summary.cells.push_back({plan.sweep_values(cell), statistics_of(sketch.cells()[cell], independence, true)});
  }
}

std::vector<Summary::Cell> summarise_cells(const Plan& plan, const Independence& independence,
                                           const TrialTable& trials) {
  if (plan.sweep_values(0).empty()) return {};
  std::vector<Tally> tallies(plan.cells());
  for (std::size_t row = 0; row < trials.index.size(); ++row) {
    tallies[plan.cell_of(trials.index[row])].add(trials.outcomes[row]);
  }
  std::vector<Summary::Cell> cells;
  cells.reserve(tallies.size());
  for (std::uint64_t cell = 0; cell < plan.cells(); ++cell) {
    cells.push_back({plan.sweep_values(cell), tallies[cell].statistics(independence, true)});
  }
  return cells;
}

/// Of trials drawn where failures are, nothing speaks of the study's distributions but the weighted rate.
void keep_what_is_weighted(const RareFailures& rare, TrialStatistics& statistics) {
  statistics.success_rate = success_rate(rare);
  statistics.effective_trials = equivalent_trials(rare);
  statistics.metrics.fill(std::nullopt);
}

void summarise_rows(const TrialTable& trials, const Plan& plan, const Independence& independence, Summary& summary) {
  Tally all;
  for (std::size_t row = 0; row < trials.index.size(); ++row) {
    if (plan.is_independent(trials.index[row])) all.add(trials.outcomes[row]);
  }
  summary.all = all.statistics(independence, false);
  summary.cells = summarise_cells(plan, independence, trials);
}

std::optional<AuditStatistics> summarise_audit(const Audit& audit, const TrialTable& trials) {
  if (audit.trials.empty()) return std::nullopt;
  AuditStatistics result;
  result.trials = audit.trials.size();
  result.tolerance = audit.tolerance;
  std::vector<double> differences;
  for (const AuditedTrial& trial : audit.trials) {
    const auto found = std::lower_bound(trials.index.begin(), trials.index.end(), trial.index);
    const TrialOutcome& outcome = trials.outcomes[static_cast<std::size_t>(found - trials.index.begin())];
    if (!agree(trial, outcome)) {
      result.disagree.push_back(trial.index);
      continue;
    }
    ++result.agree;
    if (outcome.status == Status::converged) {
      differences.push_back(std::abs(trial.settling_time - outcome.settling_time()));
    }
  }
  if (const std::optional<SampleStatistics> sample = describe(differences)) {
    result.settling_time_difference = {sample->p50, sample->p99, sample->max};
  }
  return result;
}

}  // namespace

std::string shortfall_of(const Summary& summary) {
  const bool ran_out = summary.stop && summary.stop->report.reason == StopReason::max_trials;
  if (summary.complete) return ran_out ? "the trials ran out before the precision was reached" : "";
  return "only " + readable_count(summary.completed) + " of " + readable_count(summary.requested) +
         " trials have finished";
}

Summary summarise(const Study& study, const StudyResult& result) {
  const Plan plan(study);
  Summary summary;
  summary.id = study_id(study);
  summary.name = study.name;
  summary.spec_sha256 = spec_sha256(study);
  summary.population_sha256 = population_sha256(study);
  summary.engine_version = engine_version();
  summary.seed = study.sampling.seed;
  summary.complete = result.complete;
  summary.requested = plan.trials();
  summary.completed = result.finished();
  summary.intervals = study.intervals;
  const Independence independence(study, plan, result);
  if (result.sketch) {
    summarise_sketch(*result.sketch, plan, independence, summary);
    summary.store = study.store;
  } else {
    summarise_rows(result.trials, plan, independence, summary);
  }
  summary.rare_failures = rare_failures(study, plan, result.trials);
  if (summary.rare_failures) keep_what_is_weighted(*summary.rare_failures, summary.all);
  summary.sensitivity = sobol_sensitivity(study, plan, result.trials);
  if (const auto report = watched(study, result)) summary.stop = {*study.stop, *report};
  summary.gates = judge_gates(study, plan, result, summary);
  summary.audit = summarise_audit(result.audit, result.trials);
  summary.wall_s = result.wall_s;
  summary.threads = result.threads;
  summary.simd = result.simd;
  summary.share = result.share;
  return summary;
}

}  // namespace steerstat
