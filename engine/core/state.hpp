#pragma once

namespace steerstat {

/// The robot's state x = (q1, q2, q1_dot, q2_dot) (§2 of the paper).
///
/// @tparam Real  double, a SIMD pack, or any number type with the field operations.
template <class Real>
struct State {
  Real q1{};      ///< [m] prismatic joint, actuated
  Real q2{};      ///< [rad] rotational joint, passive; unwrapped
  Real q1_dot{};  ///< [m/s]
  Real q2_dot{};  ///< [rad/s]

  friend bool operator==(const State&, const State&) = default;
};

}  // namespace steerstat
