#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace steerstat {

/// A random design: the point of the unit cube that each draw of a study takes, one coordinate a variable. A design
/// belongs to a seed and a list of variables' names. Immutable, so safe to share between threads.
class Design {
 public:
  virtual ~Design() = default;

  /// @param draw      index of the draw
  /// @param variable  position in the design's list of names
  /// @return the draw's coordinate for that variable, in (0, 1).
  [[nodiscard]] virtual double coordinate(std::uint64_t draw, std::size_t variable) const = 0;

  /// Writes all of a draw's coordinates, the bits that coordinate() returns. @param point  (variables)
  virtual void place(std::uint64_t draw, std::span<double> point) const {
    for (std::size_t variable = 0; variable < point.size(); ++variable) point[variable] = coordinate(draw, variable);
  }

  /// What a draw counts for in a mean over the draws: 1, but where they are not from the distribution that the mean is
  /// over.
  [[nodiscard]] virtual double weight(std::uint64_t /*draw*/) const { return 1.0; }

  /// Whether the draw was made as if all weights were 1.
  [[nodiscard]] virtual bool is_nominal(std::uint64_t /*draw*/) const { return true; }
};

}  // namespace steerstat
