#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace steerstat {

/// A full factorial design: every combination of the factors' levels is a cell. The last factor's level changes
/// fastest. Immutable, so safe to share between threads.
class Factorial {
 public:
  /// @param levels  (factors) how many levels each factor has, >= 1, their product below 2^64; no factors make one cell
  explicit Factorial(const std::vector<std::size_t>& levels);

  [[nodiscard]] std::uint64_t cells() const { return cells_; }

  /// @return the level that `factor` has in `cell`.
  [[nodiscard]] std::size_t level(std::uint64_t cell, std::size_t factor) const {
    const Factor& f = factors_[factor];
    return static_cast<std::size_t>(cell / f.stride % f.levels);
  }

 private:
  struct Factor {
    std::uint64_t levels;
    std::uint64_t stride;  // cells between two levels
  };
  std::vector<Factor> factors_;
  std::uint64_t cells_{1};
};

}  // namespace steerstat
