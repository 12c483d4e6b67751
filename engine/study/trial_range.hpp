#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace steerstat {

/// Consecutive trials [begin, end).
struct TrialRange {
  std::uint64_t begin;
  std::uint64_t end;
  friend bool operator==(const TrialRange&, const TrialRange&) = default;
};

/// The runs of consecutive numbers in `index`, ascending as it is.
std::vector<TrialRange> ranges_of(std::span<const std::uint64_t> index);

/// The trials [0, trials) that are in none of `known`, cut where blocks of `block` trials end.
///
/// @param known  ascending, not overlapping
/// @return ascending, each inside one block [k * block, (k + 1) * block)
std::vector<TrialRange> missing_blocks(std::span<const TrialRange> known, std::uint64_t trials, std::uint64_t block);

/// How many trials the ranges have in all, not overlapping as they are.
std::uint64_t trials_in(std::span<const TrialRange> ranges);

}  // namespace steerstat
