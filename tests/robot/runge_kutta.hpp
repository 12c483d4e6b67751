#pragma once

#include <functional>

namespace steerstat::testing {

/// Runge-Kutta 4 over [0, duration] in fixed steps, in extended precision.
///
/// @tparam Point  a struct of four numbers
template <class Point>
Point integrated(Point y, long double duration, int steps,
                 const std::function<Point(const Point&, long double)>& rates) {
  const auto moved = [](const Point& p, const Point& r, long double h) {
    const auto& [p1, p2, p3, p4] = p;
    const auto& [r1, r2, r3, r4] = r;
    return Point{p1 + h * r1, p2 + h * r2, p3 + h * r3, p4 + h * r4};
  };
  const long double h = duration / static_cast<long double>(steps);
  for (int i = 0; i < steps; ++i) {
    const long double t = h * static_cast<long double>(i);
    const Point r1 = rates(y, t);
    const Point r2 = rates(moved(y, r1, h / 2), t + h / 2);
    const Point r3 = rates(moved(y, r2, h / 2), t + h / 2);
    const Point r4 = rates(moved(y, r3, h), t + h);
    y = moved(moved(moved(moved(y, r1, h / 6), r2, h / 3), r3, h / 3), r4, h / 6);
  }
  return y;
}

}  // namespace steerstat::testing
