#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "sampling/sobol_sequence.hpp"
#include "sampling/stream.hpp"

namespace steerstat {

/// Nested uniform scrambling of one coordinate in base 2 [Owen 1995]: every digit is flipped or not by a random bit
/// that belongs to the digits before it, one bit for every node of the binary tree of digits.
///
/// Exact, and without a table. Seven levels of a subtree have 127 nodes, which one block of 128 random bits serves, so
/// five blocks scramble the 35 digits of a SobolSequence; its first 2^35 points all differ in these, so that what
/// follows is a node of each point's own, and a sixth block gives it. The bits are independent as far as Philox's
/// blocks are, which hashes of the digits that are cheaper cannot be relied on for.
///
/// Immutable and thread-safe.
class NestedScrambling {
 public:
  static constexpr unsigned digits = 52;  ///< of a scrambled coordinate

  /// @param name  of the variable: its scrambling is independent of those of others
  NestedScrambling(std::uint64_t seed, std::string_view name);

  /// @param coordinate  times 2^SobolSequence::digits
  /// @return the scrambled coordinate, rounded down, times 2^digits.
  [[nodiscard]] std::uint64_t scramble(std::uint64_t coordinate) const;

 private:
  BlockStream subtrees_;
  std::array<std::uint32_t, 4> root_;  // the subtree that all points share
};

}  // namespace steerstat
