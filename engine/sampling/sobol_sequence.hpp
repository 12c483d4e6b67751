#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace steerstat {

/// Sobol's low-discrepancy sequence in base 2 [Sobol 1967], with the direction numbers of [Joe and Kuo 2008]
/// (new-joe-kuo-6), which were chosen for good two-dimensional projections, the first dimensions' most of all; in the
/// order of [Antonov and Saleev 1979]. Not random: see Sobol for the design.
///
/// Immutable and thread-safe.
class SobolSequence {
 public:
  static constexpr std::size_t most_dimensions = 101;
  static constexpr unsigned digits = 35;  ///< binary digits of a coordinate: the sequence has 2^35 points

  /// @throws std::invalid_argument for more than most_dimensions
  explicit SobolSequence(std::size_t dimensions);

  /// @param point  < 2^digits; point 0 is the origin
  /// @return the coordinate times 2^digits. Of the first 2^m points, each has another m leading digits.
  [[nodiscard]] std::uint64_t at(std::uint64_t point, std::size_t dimension) const;

 private:
  using DirectionNumbers = std::array<std::uint64_t, digits>;
  std::vector<DirectionNumbers> directions_;  // (dimensions)
};

}  // namespace steerstat
