#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sampling/design.hpp"
#include "sampling/nested_scrambling.hpp"
#include "sampling/sobol_sequence.hpp"

namespace steerstat {

/// Sobol's sequence under Owen's scrambling: each point is uniform in the cube, and the first 2^m together are a
/// (t, m, s)-net, which fills the cube more evenly than independent points do [Owen 1997].
///
/// The sequence's dimensions go to the variables in their order, so that a variable put before others moves them to
/// other dimensions; the scrambling belongs to the seed and the variable's name. A design of more draws begins with
/// the points of one of fewer.
class Sobol : public Design {
 public:
  /// @param names  at most SobolSequence::most_dimensions
  /// @throws std::invalid_argument for more
  Sobol(std::uint64_t seed, std::span<const std::string> names);

  /// @param draw  < 2^SobolSequence::digits
  [[nodiscard]] double coordinate(std::uint64_t draw, std::size_t variable) const override;

 private:
  SobolSequence sequence_;
  std::vector<NestedScrambling> scramblings_;  // one a variable
};

}  // namespace steerstat
