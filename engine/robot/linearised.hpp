#pragma once

#include <array>

#include "core/state.hpp"

namespace steerstat {

/// The drift f of (5), the robot under partial feedback linearisation.
template <class Real>
State<Real> drift_field(const State<Real>& x) {
  return {x.q1_dot, x.q2_dot, Real(0.0), Real(0.0)};
}

/// The input field g of (5). @param coupling  K [1/m], @param s  sin q2
template <class Real>
State<Real> input_field(const Real& coupling, const Real& s) {
  return {Real(0.0), Real(0.0), Real(1.0), coupling * s};
}

/// A regular point x0 = (q1, q2, 0, q2_dot) of (5): the first joint has no velocity (§3).
template <class Real>
struct RegularPoint {
  Real q1;        ///< [m]
  Real q2;        ///< [rad]
  Real q2_dot;    ///< [rad/s]
  Real s, c;      ///< sin q2 and cos q2
  Real coupling;  ///< K [1/m]
};

/// The accessibility matrix (6), [f, g, [f, g], [g, [f, g]]] at a regular point.
///
/// @return (4 x 4) row by row; its columns are the vector fields
template <class Real>
std::array<std::array<Real, 4>, 4> accessibility_matrix(const RegularPoint<Real>& x0) {
  const Real zero(0.0);
  const Real one(1.0);
  const Real& k = x0.coupling;
  return {{{zero, zero, -one, zero},
           {x0.q2_dot, zero, -(k * x0.s), zero},
           {zero, one, zero, zero},
           {zero, k * x0.s, k * x0.c * x0.q2_dot, Real(2.0) * k * k * x0.s * x0.c}}};
}

/// The determinant of (6), -2 K^2 c s q2_dot. Where it is zero, (8) has no meaning.
template <class Real>
Real accessibility_determinant(const RegularPoint<Real>& x0) {
  return Real(-2.0) * x0.coupling * x0.coupling * x0.c * x0.s * x0.q2_dot;
}

}  // namespace steerstat
