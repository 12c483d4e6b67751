#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace steerstat {

/// How pairs of trials ended, A's and B's of the same draw, each a success or not.
struct PairedCounts {
  std::uint64_t both{0};
  std::uint64_t a_only{0};
  std::uint64_t b_only{0};
  std::uint64_t neither{0};

  [[nodiscard]] std::uint64_t pairs() const { return both + a_only + b_only + neither; }
  friend bool operator==(const PairedCounts&, const PairedCounts&) = default;
};

/// The success rate of B less that of A. @param counts  at least one pair
double difference_of(const PairedCounts& counts);

/// McNemar's test of equal success probabilities [McNemar 1947].
struct McNemarTest {
  double p_value;      ///< exact: two-sided binomial test of the discordant pairs; at most the nominal size, often less
  double mid_p_value;  ///< counts half of the observed table's probability [Fagerland 2013]: nearer to the nominal size
};

/// The exact test, given how many pairs are discordant; both values are 1 where none is.
McNemarTest mcnemar_test(const PairedCounts& counts);

/// An estimated difference of proportions with its confidence interval.
struct DifferenceInterval {
  double estimate;  ///< of B less that of A
  double low;
  double high;
  double level;
};

/// Tango's score interval of the difference between paired proportions, B less A [Tango 1998]: the differences that the
/// score test does not reject. Defined and of positive width for every table, without discordant pairs too, where it is
/// +-z^2 / (n + z^2). Swapping A and B mirrors it.
///
/// @param counts  at least one pair
/// @param level   in (0, 1)
/// @throws std::invalid_argument outside those ranges
DifferenceInterval tango_interval(const PairedCounts& counts, double level);

/// P-values adjusted so that rejecting those below a level keeps the chance of any false rejection below it, whatever
/// their dependence [Holm 1979].
///
/// @param p_values  (n)
/// @return (n) in the same order, each at least as large as it was, at most 1
std::vector<double> holm_adjusted(std::span<const double> p_values);

}  // namespace steerstat
