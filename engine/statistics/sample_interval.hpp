#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace steerstat {

/// A confidence interval of a sample's mean or quantile. A bound is empty where the sample is too small to give one at
/// the level: that side is unbounded.
struct SampleInterval {
  std::optional<double> low;
  std::optional<double> high;

  friend bool operator==(const SampleInterval&, const SampleInterval&) = default;
};

/// Ranks of the order statistics that bound a quantile, counted from 1; empty where no order statistic does.
struct QuantileRanks {
  std::optional<std::uint64_t> low;
  std::optional<std::uint64_t> high;

  friend bool operator==(const QuantileRanks&, const QuantileRanks&) = default;
};

/// The interval between the order statistics at `ranks`. @param sorted  (n) ascending, n at least each rank
SampleInterval between(std::span<const double> sorted, const QuantileRanks& ranks);

/// The distribution-free interval of the p-quantile, by ranks [Conover 1999, section 3.2]: the greatest `low` with
/// P(B < low) <= (1 - level) / 2 and the least `high` with P(B >= high) <= (1 - level) / 2, B binomial (n, p). Exact:
/// it covers with at least the level whatever the distribution of the independent values, ties included.
///
/// @param n      values in the sample, may be 0
/// @param p      in (0, 1)
/// @param level  in (0, 1)
/// @throws std::invalid_argument outside those ranges
QuantileRanks quantile_ranks(std::uint64_t n, double p, double level);

/// The interval of the p-quantile between the order statistics at quantile_ranks(); for a sample of a size fixed in
/// advance. The level holds for each p on its own.
///
/// @param sorted  (n) ascending, may be empty
SampleInterval quantile_interval(std::span<const double> sorted, double p, double level);

/// Student's t interval of the mean. Exact for normal values, approximate for others once n is in the dozens.
///
/// @param mean   of the sample
/// @param std    its standard deviation, divisor n - 1; empty where n < 2
/// @param n      values in the sample; both bounds are empty below 2
/// @param level  in (0, 1)
/// @throws std::invalid_argument for a level outside that range
SampleInterval mean_interval(double mean, std::optional<double> std, std::uint64_t n, double level);

}  // namespace steerstat
