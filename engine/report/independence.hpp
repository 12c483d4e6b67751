#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "report/summary.hpp"
#include "statistics/clustered.hpp"
#include "statistics/sample_interval.hpp"
#include "study/plan.hpp"
#include "study/run.hpp"
#include "study/study.hpp"

namespace steerstat {

/// What of a study's trials is independent of what, and the intervals that follow from it. Borrows the plan and the
/// result; safe to share between threads.
///
/// - Trials of a draw in several cells share its values: over all cells the draw is the unit (see
///   statistics/clustered.hpp). In a cell, and where nothing is drawn, it is the trial.
/// - Trials of a Latin hypercube are not independent, but of n of them the variance is at most n / (n - 1) times that
///   of independent ones, whatever is averaged [Owen 1997a]: intervals are those of n - 1.
/// - Nothing of the kind is known of Sobol's sequence at any number of points: one scrambling tells an estimate and no
///   interval that bears a level. Intervals of independent trials are given, of no unit, and no verdict rests on them.
class Independence {
 public:
  Independence(const Study& study, const Plan& plan, const StudyResult& result);

  /// @param in_cell  whether the statistics are of one cell, or of all
  [[nodiscard]] IntervalUnit unit(bool in_cell) const;

  /// Why no verdict may rest on an interval; empty where one may.
  [[nodiscard]] std::string_view doubt() const;

  /// The share of an outcome, with its interval; nothing without trials.
  [[nodiscard]] std::optional<ProportionInterval> rate(Status outcome, const TrialStatistics& statistics,
                                                       bool in_cell) const;

  /// How many independent trials the interval of the success rate counts.
  [[nodiscard]] double effective_trials(const TrialStatistics& statistics, bool in_cell) const;

  /// The interval of the mean of a metric that the statistics are of.
  [[nodiscard]] SampleInterval mean(const Metric& metric, const SampleStatistics& sample, bool in_cell) const;

  /// The interval of the p-quantile of a metric.
  ///
  /// @param sorted  (n) its values, ascending
  [[nodiscard]] SampleInterval quantile(const Metric& metric, std::span<const double> sorted, double p,
                                        bool in_cell) const;

  /// The ranks that bound the p-quantile of n values, where the trial is the unit.
  [[nodiscard]] QuantileRanks quantile_ranks_of_trials(std::uint64_t n, double p) const;

 private:
  [[nodiscard]] std::vector<ClusterSum> by_draw(const std::function<double(const TrialOutcome&)>& value) const;
  [[nodiscard]] EqualClusters by_draw(Status outcome) const;
  [[nodiscard]] double stratified(double trials) const;

  const Study& study_;
  const Plan& plan_;
  const TrialTable& trials_;
  const TrialSketch* sketch_;  // null where all rows are there
};

}  // namespace steerstat
