#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "trial/trial.hpp"

namespace steerstat {

/// A number that describes a trial, under the name that summaries, gates and stopping rules know it by.
struct Metric {
  std::string_view name;
  std::string_view unit;                 ///< "1" where it has none
  double (*value)(const TrialOutcome&);  ///< NaN for a trial that does not have it, never infinite
  bool optional{false};                  ///< left out where IntegratorChoice::metrics is false
};

inline constexpr std::size_t metric_count = 10;

/// Every metric (metric_count), always in the same order. Defined in schemas/result_file.md.
///
/// settling_time and cycles are the converged trials' alone; effort and the peaks are every trial's, where finite; the
/// contraction ratios are those of the trials that finished a contraction cycle.
std::span<const Metric> metrics();

/// @return the metric called `name`, or null where there is none
const Metric* find_metric(std::string_view name);

/// Where a metric stands in metrics(). @throws std::invalid_argument for a name that no metric has
std::size_t metric_index(std::string_view name);

}  // namespace steerstat
