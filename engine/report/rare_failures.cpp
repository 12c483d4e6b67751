#include "report/rare_failures.hpp"

#include <algorithm>

#include "study/subset_simulation.hpp"

namespace steerstat {
namespace {

WeightedFailures weighted(const Study& study, const Plan& plan, const TrialTable& trials) {
  std::vector<WeightedDraw> draws;
  draws.reserve(trials.index.size());
  for (std::size_t row = 0; row < trials.index.size(); ++row) {
    const std::uint64_t index = trials.index[row];
    const bool failed = trials.outcomes[row].status != Status::converged;
    draws.push_back({plan.weight(index), plan.is_nominal(index), failed});
  }
  return weighted_failures(draws, study.intervals.level);
}

SubsetFailures by_levels(const Study& study, const TrialTable& trials) {
  const SubsetLevels levels = subset_levels(study, trials);
  return {subset_estimate(levels, study.intervals.level), levels.levels(), *levels.end()};
}

}  // namespace

std::optional<RareFailures> rare_failures(const Study& study, const Plan& plan, const TrialTable& trials) {
  if (!seeks_failures(study.sampling.method) || trials.index.empty()) return std::nullopt;
  const double level = study.intervals.level;
  if (study.sampling.method == SamplingMethod::importance) return RareFailures{weighted(study, plan, trials), level};
  return RareFailures{by_levels(study, trials), level};
}

FailureRate failure_rate(const RareFailures& rare) {
  if (const auto* w = std::get_if<WeightedFailures>(&rare.found)) {
    return {w->estimate, w->standard_error, w->low, w->high, w->trusted, w->reason, w->nominal, w->nominal_interval};
  }
  const SubsetEstimate& s = std::get<SubsetFailures>(rare.found).found;
  return {s.estimate, s.estimate * s.variation, s.low, s.high, s.trusted, s.reason, s.nominal, s.nominal_interval};
}

ProportionInterval success_rate(const RareFailures& rare) {
  const FailureRate rate = failure_rate(rare);
  return {1.0 - std::min(rate.estimate, 1.0), 1.0 - rate.high, 1.0 - rate.low, rare.level};
}

double equivalent_trials(const RareFailures& rare) {
  const FailureRate rate = failure_rate(rare);
  if (!rate.trusted) return static_cast<double>(rate.nominal.trials);
  const double p = std::min(rate.estimate, 1.0);
  return p * (1.0 - p) / (rate.standard_error * rate.standard_error);
}

std::string_view interval_method(const RareFailures& rare) {
  if (!failure_rate(rare).trusted) return "clopper_pearson";
  return std::holds_alternative<WeightedFailures>(rare.found) ? "fay_feuer" : "lognormal";
}

}  // namespace steerstat
