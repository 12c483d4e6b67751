#pragma once

#include <cmath>
#include <numbers>

#include "core/state.hpp"

namespace steerstat {

/// The desired rest configuration and the geometry of its quadrant (CONTROLLER.md section 4, from §4.1-4.2).
struct Goal {
  double q1{0.0};     ///< [m]
  double q2{0.0};     ///< [rad]
  double sigma{1.0};  ///< +1 when q2 is in quadrant I or III, -1 in II or IV
  double edge{0.0};   ///< [rad] approach edge: the quadrant's lower bound when sigma = +1, else its upper bound
  double width{0.0};  ///< [rad] w = |q2 - edge|

  friend bool operator==(const Goal&, const Goal&) = default;
};

/// @return the goal (q1, q2) with its quadrant's geometry.
inline Goal goal_at(double q1, double q2) {
  constexpr double quarter = std::numbers::pi / 2;
  const double k = std::floor(q2 / quarter);
  const bool even = k == 2.0 * std::floor(k / 2.0);
  const double edge = even ? k * quarter : (k + 1.0) * quarter;
  return {q1, q2, even ? 1.0 : -1.0, edge, std::abs(q2 - edge)};
}

/// Below this |sin 2 q2_goal| the contraction sets are empty and the goal is refused.
inline constexpr double least_goal_sine = 1e-3;

/// x modulo 2 pi, in [0, 2 pi); off by at most 2^-51 max(|x|, 2 pi) on the circle. NaN for a non-finite x.
inline double modulo_turn(double x) {
  constexpr double turn = 2.0 * std::numbers::pi;
  const double y = x - turn * std::floor(x / turn);
  // Rounding may leave y a little outside; NaN fails both comparisons and stays NaN.
  return (y < 0.0 || y >= turn) ? 0.0 : y;
}

/// x wrapped to (-pi, pi]. NaN for a non-finite x.
inline double wrap(double x) {
  const double y = modulo_turn(x);
  return y > std::numbers::pi ? y - 2.0 * std::numbers::pi : y;
}

/// sqrt((q1 - q1_goal)^2 + q1_dot^2), the first joint's error as a norm.
inline double active_error(const State<double>& x, const Goal& goal) {
  const double e = x.q1 - goal.q1;
  return std::sqrt(e * e + x.q1_dot * x.q1_dot);
}

/// |wrap(q2 - q2_goal)| + |q2_dot|, the paper's epsilon (§5).
inline double passive_error(const State<double>& x, const Goal& goal) {
  return std::abs(wrap(x.q2 - goal.q2)) + std::abs(x.q2_dot);
}

}  // namespace steerstat
