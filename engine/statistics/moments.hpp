#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "statistics/superaccumulator.hpp"

namespace steerstat {

/// Number, range, mean and spread of values that are not kept. Exact until the end, so that the order of the values,
/// and how they were shared out among several of these, makes no difference, to the bit.
class Moments {
 public:
  /// @param value  finite
  void add(double value);
  void add(const Moments& other);

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double min() const { return min_; }  ///< infinite where there are no values
  [[nodiscard]] double max() const { return max_; }

  /// The mean, within [min, max]: the same bits as that of describe(). @pre count() > 0
  [[nodiscard]] double mean() const;

  /// The standard deviation, divisor n - 1: of the exact sum of squares, rounded at the end. None for fewer than two
  /// values, nor where one is 2^511 or more in size, whose square is no double.
  [[nodiscard]] std::optional<double> standard_deviation() const;

  /// The exact sums, to be stored.
  [[nodiscard]] const Superaccumulator& sum() const { return sum_; }
  [[nodiscard]] const Superaccumulator& squares() const { return squares_; }

  /// What was stored.
  static Moments of(std::uint64_t count, double min, double max, const Superaccumulator& sum,
                    const Superaccumulator& squares);

  friend bool operator==(const Moments&, const Moments&) = default;

 private:
  std::uint64_t count_{0};
  double min_{std::numeric_limits<double>::infinity()};
  double max_{-std::numeric_limits<double>::infinity()};
  Superaccumulator sum_;
  Superaccumulator squares_;  // of the values below 2^511 in size
};

}  // namespace steerstat
