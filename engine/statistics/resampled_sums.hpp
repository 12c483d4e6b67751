#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "statistics/resampling.hpp"
#include "statistics/sensitivity_bins.hpp"

namespace steerstat {

/// Sums over units: of their counts of trials, their sums of y, the squares of both, and y^2.
struct UnitSums {
  double count{0.0}, sum{0.0}, count_squares{0.0}, sum_squares{0.0}, squares{0.0};

  void add(const BinEntry& unit) {
    count += unit.count;
    sum += unit.sum;
    count_squares += unit.count * unit.count;
    sum_squares += unit.sum * unit.sum;
    squares += unit.squares;
  }

  /// Ordered pairs of trials of different units.
  [[nodiscard]] double pairs() const { return count * count - count_squares; }

  /// Mean of y_j y_k over them; NaN where there are none.
  [[nodiscard]] double mean_over_pairs() const {
    return pairs() > 0.0 ? (sum * sum - sum_squares) / pairs() : std::numeric_limits<double>::quiet_NaN();
  }
};

using ResampledSums = std::array<UnitSums, resample_count>;

/// The sums over those units that are in each resample (resampling_word()).
///
/// Units are taken eight at a time: of the 256 subsets of eight each has its sums computed once, and every resample
/// then adds the one that it has.
///
/// @param units  each unit once
ResampledSums resampled_sums(std::span<const BinEntry> units, std::uint64_t seed);

}  // namespace steerstat
