#pragma once

#include <cmath>

#include "core/state.hpp"
#include "robot/plant.hpp"

namespace steerstat {

/// Forces on the true plant that the controller's model leaves out (README.md of this room); all off by default.
template <class Real>
struct Disturbance {
  Real coulomb1{0.0};         ///< [N] Coulomb friction of the prismatic joint, >= 0
  Real coulomb2{0.0};         ///< [N m] Coulomb friction of the rotational joint, >= 0
  Real coulomb_speed1{1e-3};  ///< [m/s] smoothing velocity of coulomb1, > 0
  Real coulomb_speed2{1e-3};  ///< [rad/s] smoothing velocity of coulomb2, > 0
  Real gravity_x{0.0};        ///< [m/s^2] gravity in the plane of a tilted robot, along the axis of q1
  Real gravity_y{0.0};        ///< [m/s^2] gravity in that plane, across the axis of q1, towards q2 = pi/2

  friend bool operator==(const Disturbance&, const Disturbance&) = default;
};

/// Whether there is any such force.
template <class Real>
bool is_present(const Disturbance<Real>& d) {
  const Real none(0.0);
  return d.coulomb1 != none || d.coulomb2 != none || d.gravity_x != none || d.gravity_y != none;
}

/// The share of Coulomb friction that acts at a velocity, (R2): -1 to 1, with the velocity's sign.
///
/// @param smoothing  > 0, in the velocity's unit
template <class Real>
Real coulomb_share(const Real& velocity, const Real& smoothing) {
  using std::sqrt;
  return velocity / sqrt(velocity * velocity + smoothing * smoothing);
}

/// The disturbance's generalised forces on both joints, (R1).
///
/// @param x     state; only the velocities are read
/// @param s, c  sin q2 and cos q2
template <class Real>
GeneralisedForces<Real> disturbing_forces(const PlantConstants<Real>& k, const Disturbance<Real>& d,
                                          const State<Real>& x, const Real& s, const Real& c) {
  return {k.mass * d.gravity_x - d.coulomb1 * coulomb_share(x.q1_dot, d.coulomb_speed1),
          k.moment * (d.gravity_y * c - d.gravity_x * s) - d.coulomb2 * coulomb_share(x.q2_dot, d.coulomb_speed2)};
}

/// Potential energy of the tilted robot [J], zero where both links' centres of mass are at the origin of q1.
///
/// @param x  state; only q1 is read
template <class Real>
Real potential_energy(const PlantConstants<Real>& k, const Disturbance<Real>& d, const State<Real>& x, const Real& s,
                      const Real& c) {
  return -(k.mass * d.gravity_x * x.q1 + k.moment * (d.gravity_x * c + d.gravity_y * s));
}

}  // namespace steerstat
