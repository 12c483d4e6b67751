#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace steerstat {

/// Mean, spread and quantiles of a sample.
struct SampleStatistics {
  double mean;
  std::optional<double> std;  ///< standard deviation, divisor n - 1; none for a sample of one
  double min, p05, p50, p95, p99, max;
  std::uint64_t count;  ///< values in the sample, > 0

  friend bool operator==(const SampleStatistics&, const SampleStatistics&) = default;
};

/// Sorts a sample by its digits, in a third of the time that comparing takes.
///
/// @param sample  (n) without NaN; -0 comes before 0
void sort_ascending(std::span<double> sample);

/// The p-quantile of a sorted sample: definition 7 of [Hyndman and Fan 1996], linear between the order statistics
/// x[floor h] and x[floor h + 1] (counted from 0) at h = (n - 1) p. The default of R and NumPy.
///
/// @param sorted  (n) ascending, n > 0
/// @param p       in [0, 1]; 0 gives the least and 1 the greatest value
/// @throws std::invalid_argument outside those ranges
double quantile(std::span<const double> sorted, double p);

/// The statistics of a sample; nothing for an empty one. Mean and spread are the same bits in whatever order the
/// sample comes.
///
/// @param sample  (n) finite values
std::optional<SampleStatistics> describe(std::span<const double> sample);

}  // namespace steerstat
