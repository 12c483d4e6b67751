#pragma once

#include <cstdint>

namespace steerstat {

/// An estimated proportion with its confidence interval.
struct ProportionInterval {
  double estimate;  ///< successes / trials
  double low;
  double high;
  double level;  ///< e.g. 0.95
};

/// Wilson's score interval [Wilson 1927], defined at 0 and at `trials` successes.
///
/// @param successes  <= trials
/// @param trials     > 0
/// @param level      in (0, 1)
/// @throws std::invalid_argument outside those ranges
ProportionInterval wilson_interval(std::uint64_t successes, std::uint64_t trials, double level);

}  // namespace steerstat
