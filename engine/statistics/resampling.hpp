#pragma once

#include <cstddef>
#include <cstdint>

namespace steerstat {

/// How an estimate's interval is found by resampling.
struct Resampling {
  double level{0.95};     ///< of the interval, in (0, 1)
  std::uint64_t seed{1};  ///< the same seed gives the same interval
};

/// Resamples come in batches of 64: bit k of a word belongs to resample 64 batch + k.
inline constexpr std::size_t resamples_a_batch = 64;
inline constexpr std::size_t resample_batches = 4;
inline constexpr std::size_t resample_count = resamples_a_batch * resample_batches;

/// Which of a batch's 64 resamples observation `unit` is in: each with probability 1/2, independently. A pure function
/// (two rounds of SplitMix64's mixing [Steele 2014] over a counter), so resamples depend on no order and no thread.
///
/// Double-or-nothing bootstrap [Owen and Eckles 2012]: an observation weighs 2 or 0, mean 1 and variance 1 as in
/// Efron's. The estimate from a resample, less that from all observations, spreads as the latter does about the truth
/// [Praestgaard and Wellner 1993]: half of n observations vary by 1 / (n / 2) - 1 / n = 1 / n about all of them. No
/// observation comes twice, so what is estimated from pairs of different observations still is.
inline std::uint64_t resampling_word(std::uint64_t seed, std::uint64_t unit, std::size_t batch) {
  const auto mix = [](std::uint64_t z) {
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  };
  constexpr std::uint64_t golden = 0x9e3779b97f4a7c15U;
  return mix(mix(mix(seed + golden) + golden * (unit + 1)) + golden * (batch + 1));
}

}  // namespace steerstat
