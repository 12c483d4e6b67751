#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace steerstat {

/// How precise one estimate must be.
struct PrecisionGoal {
  std::string metric;              ///< of rate_names() or metrics()
  std::optional<double> quantile;  ///< in (0, 1), of a metric: which quantile; none for a rate
  double half_width{0.0};          ///< > 0: of the estimate's interval, at most this
  bool relative{false};            ///< whether half_width is a share of the estimate's magnitude

  friend bool operator==(const PrecisionGoal&, const PrecisionGoal&) = default;
};

/// When a study has seen enough: at the first look at which every goal holds in every cell. It looks after min_trials
/// draws and then after every check_every more, at the trials with smaller indices alone, so that where it stops
/// depends on the spec and on nothing else. The sampling's trials are the most it takes.
///
/// The intervals are confidence sequences: each holds at all looks together with probability `level`, so that stopping
/// when it is narrow enough does not spoil it. Several goals, or cells, hold at their levels each, not jointly.
struct StopRule {
  std::uint64_t min_trials{1};      ///< draws before the first look, <= the sampling's trials
  std::uint64_t check_every{1000};  ///< draws between looks
  double level{0.95};
  std::vector<PrecisionGoal> until;  ///< at least one

  friend bool operator==(const StopRule&, const StopRule&) = default;
};

}  // namespace steerstat
