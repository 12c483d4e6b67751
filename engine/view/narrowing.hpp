#pragma once

#include <cstdint>
#include <vector>

#include "view/viewed_study.hpp"

namespace steerstat {

/// How the success rate and its interval narrowed as trials came in.
struct Narrowing {
  std::uint64_t of{0};                ///< trials looked at: those that count before the first that has not finished
  IntervalChoice intervals;           ///< by which each interval is
  std::vector<std::uint64_t> trials;  ///< (points) rising, the last is `of`
  std::vector<double> estimate;       ///< (points)
  std::vector<double> low, high;      ///< (points)
};

/// Over several cells the draw is the unit, as in the summary (Independence).
///
/// @param points  about how many, evenly spaced on a log axis; of a swept study each is after a whole draw of all cells
Narrowing narrowing_of(const ViewedStudy& viewed, std::size_t points = 100);

}  // namespace steerstat
