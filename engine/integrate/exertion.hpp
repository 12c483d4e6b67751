#pragma once

#include <cmath>

#include "core/state.hpp"

namespace steerstat {

/// What a course asks of the first joint, from its start to where it stands.
struct Exertion {
  double effort{0.0};             ///< [N^2 s] integral of tau^2
  double peak_acceleration{0.0};  ///< [m/s^2] largest |a|
  double peak_force{0.0};         ///< [N] largest |tau|
  double peak_stroke{0.0};        ///< [m] largest |q1 - q1_goal|

  friend bool operator==(const Exertion&, const Exertion&) = default;
};

/// What a course asks that starts at x, before it has gone anywhere: nothing but the stroke.
inline Exertion exertion_at(const State<double>& x, double q1_goal) {
  Exertion exertion;
  exertion.peak_stroke = std::abs(x.q1 - q1_goal);
  return exertion;
}

}  // namespace steerstat
