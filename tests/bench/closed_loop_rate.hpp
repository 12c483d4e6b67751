#pragma once

#include <array>
#include <cmath>

#include "integrate/closed_loop.hpp"

namespace steerstat::bench {

/// A state as libraries of ordinary differential equations want it: q1, q2, q1_dot, q2_dot.
using Vector = std::array<double, 4>;

inline State<double> state_of(const double* y) {
  return {y[0], y[1], y[2], y[3]};
}
inline Vector vector_of(const State<double>& x) {
  return {x.q1, x.q2, x.q1_dot, x.q2_dot};
}
inline bool is_finite(const Vector& y) {
  return std::isfinite(y[0]) && std::isfinite(y[1]) && std::isfinite(y[2]) && std::isfinite(y[3]);
}

/// The right-hand side of one phase.
struct ClosedLoopRate {
  ClosedLoop<double> loop{};
  Phase phase{};

  /// @param t  [s] since the phase's start
  void operator()(const double* y, double* dydt, double t) const {
    const State<double> x = state_of(y);
    const State<double> rate =
        derivative(loop, commanded_acceleration(loop, phase, t, x), x, std::sin(x.q2), std::cos(x.q2));
    dydt[0] = rate.q1;
    dydt[1] = rate.q2;
    dydt[2] = rate.q1_dot;
    dydt[3] = rate.q2_dot;
  }
};

/// Length [s] of the first step tried in a phase: near what the steps turn out to be.
inline double first_step(const Phase& phase) {
  return phase.kind == PhaseKind::drift ? 2.0 : 0.25;
}

}  // namespace steerstat::bench
