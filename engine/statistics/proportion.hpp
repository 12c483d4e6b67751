#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace steerstat {

/// An estimated proportion with its confidence interval.
struct ProportionInterval {
  double estimate;  ///< successes / trials
  double low;
  double high;
  double level;  ///< e.g. 0.95
};

/// Wilson's score interval [Wilson 1927], defined at 0 and at `trials` successes. Its coverage is the level on average
/// over the proportion, and falls below it at some.
///
/// @param successes  <= trials
/// @param trials     > 0
/// @param level      in (0, 1)
/// @throws std::invalid_argument outside those ranges
ProportionInterval wilson_interval(std::uint64_t successes, std::uint64_t trials, double level);

/// The exact interval of [Clopper and Pearson 1934]: the proportions that neither one-sided binomial test at
/// (1 - level) / 2 rejects. Its coverage is never below the level, so it is wider than Wilson's. Closed at 0 and at
/// `trials` successes. Parameters and errors as of wilson_interval().
ProportionInterval clopper_pearson_interval(std::uint64_t successes, std::uint64_t trials, double level);

/// Where a proportion's interval comes from.
enum class ProportionMethod : std::uint8_t { wilson, clopper_pearson, confidence_sequence };
inline constexpr std::array<std::string_view, 3> proportion_method_names{"wilson", "clopper_pearson",
                                                                         "confidence_sequence"};

/// The interval by the method asked for; confidence_sequence() is the one that holds where the number of trials was
/// decided by looking at them. Parameters and errors as of wilson_interval().
ProportionInterval proportion_interval(ProportionMethod method, std::uint64_t successes, std::uint64_t trials,
                                       double level);

/// Wilson's or Clopper and Pearson's interval where the number of trials is an effective one, not whole, and with it
/// that of successes [Korn and Graubard 1998].
///
/// @param share   of successes, in [0, 1]: the estimate
/// @param trials  > 0
/// @throws std::invalid_argument outside those ranges, and for the method confidence_sequence
ProportionInterval proportion_interval_of_share(ProportionMethod method, double share, double trials, double level);

}  // namespace steerstat
