#pragma once

#include <limits>

namespace steerstat {

/// What the first joint's actuator makes of the force that it is asked for (README.md of this room); ideal by default.
template <class Real>
struct Actuator {
  Real gain{1.0};                                           ///< > 0
  Real max_force{std::numeric_limits<double>::infinity()};  ///< [N] > 0; infinite: no limit

  friend bool operator==(const Actuator&, const Actuator&) = default;
};

/// The force on the first joint [N], (R3): clamp(gain tau, -max_force, max_force). Of the ideal actuator, tau itself.
///
/// @param tau  [N] force that the controller asks for; where it is not a number, neither is the result
template <class Real>
Real applied_force(const Actuator<Real>& actuator, const Real& tau) {
  const Real force = actuator.gain * tau;
  if (force > actuator.max_force) return actuator.max_force;
  if (force < -actuator.max_force) return -actuator.max_force;
  return force;
}

}  // namespace steerstat
