#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "statistics/proportion.hpp"
#include "statistics/proportion_drop.hpp"

namespace steerstat {

/// A draw of an importance sample.
struct WeightedDraw {
  double weight;  ///< > 0: the nominal density over the proposal's, at the draw
  bool nominal;   ///< drawn from the nominal density itself, not from the rest of the proposal
  bool failed;
};

/// What an importance sample says of the probability of failure.
///
/// - The estimate is the sum of the failed draws' weights over the number of draws. Not over the sum of all weights:
///   unnormalised it is unbiased, and it rests on the failed draws alone, among which a proposal made for them has
///   nearly equal weights; the sum of all weights is mostly that of draws that did not fail, whose weights the proposal
///   was not made to tame.
/// - Its interval is that of a weighted sum of Poisson counts by the gamma distribution [Fay and Feuer 1997], whose
///   upper limit allows for one failure more, of the largest weight seen: with equal weights it is the exact one, with
///   unequal ones it errs on the wide side. It knows of no failures where the proposal never looked.
/// - The nominal draws alone are a plain sample, whose exact interval [Clopper and Pearson 1934] holds whatever the
///   proposal misses.
/// - The estimate is trusted where at least `least_effective_failures` failures count [Kish 1965], none has more than
///   `largest_trusted_share` of the sum, and the weights of all draws average to 1 within 4 standard errors, as they
///   must where the sample covers what it is to stand for. Where it is not, the interval is the nominal draws'.
struct WeightedFailures {
  static constexpr double least_effective_failures = 20.0;
  static constexpr double largest_trusted_share = 0.1;

  std::uint64_t draws{0};
  std::uint64_t failures{0};
  double estimate{0.0};        ///< may exceed 1 by chance
  double standard_error{0.0};  ///< of the estimate
  double low{0.0};             ///< of the interval that is to be relied on
  double high{1.0};
  double effective_draws{0.0};                         ///< (sum of weights)^2 / sum of squares [Kish 1965]
  double effective_failures{0.0};                      ///< the same of the failed draws; 0 without
  double largest_share{0.0};                           ///< of one failed draw's weight in their sum; 0 without
  double mean_weight{0.0};                             ///< of all draws
  ProportionCount nominal{};                           ///< failures and draws among the nominal ones
  std::optional<ProportionInterval> nominal_interval;  ///< nothing without nominal draws
  bool trusted{false};
  std::string reason;  ///< why it is not trusted, one clause; empty where it is
};

/// @param draws  (n), n > 0
/// @param level  in (0, 1), of both intervals
/// @throws std::invalid_argument without draws, or for a level outside
WeightedFailures weighted_failures(std::span<const WeightedDraw> draws, double level);

/// The interval of [Fay and Feuer 1997] for the expected sum of the failures' weights.
struct WeightedSumInterval {
  double low;
  double high;
};

/// @param sum, squares, largest  of the weights of the failures, of which there are some: > 0
/// @param level                  in (0, 1)
/// @throws std::invalid_argument outside those ranges
WeightedSumInterval weighted_sum_interval(double sum, double squares, double largest, double level);

}  // namespace steerstat
