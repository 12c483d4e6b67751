#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "statistics/proportion.hpp"
#include "statistics/subset_levels.hpp"
#include "statistics/weighted_failures.hpp"
#include "study/plan.hpp"
#include "study/study.hpp"
#include "study/trial_table.hpp"

namespace steerstat {

/// What the levels of a subset simulation say.
struct SubsetFailures {
  SubsetEstimate found;
  std::vector<SubsetLevel> levels;
  SubsetEnd end;
};

/// What a study that seeks failures says of how often they are.
struct RareFailures {
  std::variant<WeightedFailures, SubsetFailures> found;  ///< by importance sampling, by subset simulation
  double level;                                          ///< of the intervals
};

/// @return nothing for sampling that does not seek failures, nor without trials
std::optional<RareFailures> rare_failures(const Study& study, const Plan& plan, const TrialTable& trials);

/// What both methods tell of the rate of failure.
struct FailureRate {
  double estimate;          ///< that of importance sampling may exceed 1 by chance
  double standard_error;    ///< of the estimate
  double low, high;         ///< the interval that is to be relied on
  bool trusted;             ///< whether the estimate is; else the interval is that of the nominal draws
  std::string reason;       ///< why not
  ProportionCount nominal;  ///< failures and trials among plain draws
  std::optional<ProportionInterval> nominal_interval;  ///< Clopper-Pearson; nothing without such draws
};
FailureRate failure_rate(const RareFailures& rare);

/// The success rate that belongs to the rate of failure, with the interval that is to be relied on.
ProportionInterval success_rate(const RareFailures& rare);

/// How many plain trials would tell the rate of failure as precisely.
double equivalent_trials(const RareFailures& rare);

/// As a summary names the interval: fay_feuer or lognormal, or clopper_pearson where it is that of the nominal draws.
std::string_view interval_method(const RareFailures& rare);

}  // namespace steerstat
