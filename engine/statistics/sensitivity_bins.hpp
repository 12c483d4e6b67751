#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace steerstat {

/// What the trials of one unit that have the same x come to.
struct BinEntry {
  double x;
  std::uint64_t unit;
  double count;    ///< of trials
  double sum;      ///< of their y
  double squares;  ///< sum of y^2
};

/// The trials by rising x, then unit.
///
/// @param x, y, unit  (trials)
std::vector<BinEntry> sorted_entries(std::span<const double> x, std::span<const double> y,
                                     std::span<const std::uint64_t> unit);

/// Where bins end: for each its last entry's position plus 1. No value of x is in two bins. Where values have 8 entries
/// on average each is a bin of its own; else bins have about 8 entries, or more where that would make over 4,096 bins.
///
/// @param entries  by rising x
std::vector<std::size_t> bin_ends(std::span<const BinEntry> entries);

/// Makes one entry of those of the same unit, which are then by rising unit (and have no x of their own).
void merge_units(std::vector<BinEntry>& entries);

}  // namespace steerstat
