#pragma once

#include <cstdint>
#include <optional>

namespace steerstat {

/// Successes of a number of independent trials.
struct ProportionCount {
  std::uint64_t successes;  ///< <= trials
  std::uint64_t trials;     ///< > 0
};

/// By how much a proportion has dropped, with one-sided limits.
struct ProportionDrop {
  double estimate;  ///< before - after; negative where it has risen
  double low;       ///< the drop is greater than this, with confidence 1 - level
  double high;      ///< the drop is less than this, with confidence 1 - level
};

/// Limits of the drop between two independent samples, square-and-add [Newcombe 1998 independent, method 10; Zou and
/// Donner 2008] of one-sided Clopper-Pearson limits. Defined at 0 and at `trials` successes.
///
/// Newcombe adds Wilson limits; those of Clopper and Pearson cost a little power and keep the level near 0 and 1, where
/// success rates stand: with Wilson's a drop of nothing is found significant up to 12 % of the time instead of 5 %. The
/// tests enumerate the error rates of both limits.
///
/// @param level  of each limit, in (0, 0.5): e.g. 0.05
/// @throws std::invalid_argument outside those ranges
ProportionDrop proportion_drop(const ProportionCount& before, const ProportionCount& after, double level);

/// The smallest drop from `before` that a sample of `trials` shows to be one (proportion_drop().low > 0) with
/// probability `power`: exact, given `before` as it was seen.
///
/// @param level  as above
/// @param power  in (0.5, 1)
/// @return nothing where no outcome of the sample would show a drop
/// @throws std::invalid_argument outside those ranges
std::optional<double> detectable_drop(const ProportionCount& before, std::uint64_t trials, double level, double power);

}  // namespace steerstat
