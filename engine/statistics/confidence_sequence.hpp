#pragma once

#include <cstdint>
#include <span>

#include "statistics/proportion.hpp"
#include "statistics/sample_interval.hpp"

/// Intervals that hold at all sample sizes at once, so that whoever watches a study grow may stop it whenever the
/// interval pleases. An interval of a fixed sample size, looked at again and again, misses in the end with certainty.
namespace steerstat {

/// The logarithm of how much better the proportions explain a Bernoulli sequence when mixed by Beta(1/2, 1/2) than
/// `p` does: log of the integral of q^S (1 - q)^(n - S) over the mixture, less log of p^S (1 - p)^(n - S).
///
/// At the true p the ratio itself is a martingale of mean 1 over the growing sequence, and so exceeds 1 / alpha at any
/// time with probability alpha at most [Ville 1939; Robbins 1970]. This mixture is within about log(n) / 2 of the best
/// q in hindsight whatever q is, 0 and 1 included [Krichevsky and Trofimov 1981]: success rates worth having are near
/// 1, where a uniform mixture would lose twice that.
///
/// The same bits on every machine.
///
/// @param successes  <= trials
/// @param trials     may be 0, where the ratio is 1
/// @param p          in [0, 1]; infinity where the sequence is impossible under p
double log_mixture_ratio(std::uint64_t successes, std::uint64_t trials, double p);

/// The interval of a Bernoulli sequence's confidence sequence [Howard et al. 2021]: all p whose mixture ratio is below
/// 1 / (1 - level). With probability `level` it covers the true p after every number of trials, however often it is
/// looked at and whatever that decides. Closed at 0 and at `trials` successes. The same bits on every machine.
///
/// @param successes  <= trials
/// @param trials     > 0
/// @param level      in (0, 1)
/// @throws std::invalid_argument outside those ranges
ProportionInterval confidence_sequence(std::uint64_t successes, std::uint64_t trials, double level);

/// The ranks that bound the p-quantile at all sample sizes at once [Howard and Ramdas 2022]. For the one true quantile
/// x, whether each value is at or below x is a Bernoulli sequence of proportion p (where values tie at x, break the
/// ties at random): with probability `level` the number of values there has a mixture ratio below 1 / (1 - level) at
/// every n, and then x lies between the order statistics at these ranks. Holds for each p on its own. The same bits on
/// every machine.
///
/// @param n      values in the sample, may be 0
/// @param p      in (0, 1)
/// @param level  in (0, 1)
/// @throws std::invalid_argument outside those ranges
QuantileRanks confidence_sequence_ranks(std::uint64_t n, double p, double level);

/// The interval of the p-quantile between the order statistics at confidence_sequence_ranks().
///
/// @param sorted  (n) ascending, may be empty
SampleInterval quantile_confidence_sequence(std::span<const double> sorted, double p, double level);

}  // namespace steerstat
