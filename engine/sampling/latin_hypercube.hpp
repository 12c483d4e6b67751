#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sampling/design.hpp"
#include "sampling/permutation.hpp"
#include "sampling/stream.hpp"

namespace steerstat {

/// Latin hypercube sampling [McKay 1979]: of n draws, each variable takes exactly one in each of n equal strata of
/// (0, 1), in random order and at a random place of its stratum.
///
/// A variable's draws depend on the seed, its own name and n. Strata are those of n draws, so a design of more draws
/// shares no points with one of fewer: extending it draws anew.
class LatinHypercube : public Design {
 public:
  /// @param draws  n, 1 to 2^32
  LatinHypercube(std::uint64_t draws, std::uint64_t seed, std::span<const std::string> names);

  /// @param draw  < n
  [[nodiscard]] double coordinate(std::uint64_t draw, std::size_t variable) const override;

 private:
  struct Variable {
    Permutation strata;
    BlockStream places;
  };
  std::vector<Variable> variables_;
  double draws_;
  unsigned place_bits_;  // of the random place in a stratum
  double place_size_;    // 2^-place_bits_ of a stratum
};

}  // namespace steerstat
