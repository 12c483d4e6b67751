#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace steerstat {

/// Which points of some curves to draw.
struct Thinned {
  std::vector<std::size_t> kept;  ///< rising
  /// Farthest that a straight line between neighbours kept passes, at its time, from a point left out, over the
  /// column's range; 0 where none was left out.
  double largest_deviation{0.0};
};

/// Chooses points of curves over time that look like all of them, as [Douglas and Peucker 1973] do: of all points left
/// out, that one is taken next which is farthest from the line between its neighbours, in whatever column.
///
/// @param t        (points) [s] never falling
/// @param columns  the curves, (points) each, finite or ignored where not
/// @param fixed    points that stay, rising, the first and the last point among them; at most `most`
/// @param most     how many to keep
Thinned thin(std::span<const double> t, std::span<const std::vector<double>> columns,
             std::span<const std::size_t> fixed, std::size_t most);

}  // namespace steerstat
