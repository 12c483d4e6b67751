#pragma once

#include "core/state.hpp"

namespace steerstat {

/// Parameters of the PR robot (§2, §5). A trial has two sets: the nominal one, which the controller believes, and the
/// true one, which the plant has.
template <class Real>
struct PlantParameters {
  Real m1{1.0};  ///< [kg] mass of link 1, > 0
  Real m2{1.0};  ///< [kg] mass of link 2, > 0
  Real d2{0.5};  ///< [m] joint axis to centre of mass of link 2, non-zero
  Real I2{1.0};  ///< [kg m^2] barycentral inertia of link 2, > 0
  Real f1{0.0};  ///< [N s/m] viscous friction of the prismatic joint, >= 0
  Real f2{0.0};  ///< [N m s/rad] viscous friction of the rotational joint, >= 0

  friend bool operator==(const PlantParameters&, const PlantParameters&) = default;
};

/// Joint accelerations.
template <class Real>
struct Accelerations {
  Real q1_ddot{};  ///< [m/s^2]
  Real q2_ddot{};  ///< [rad/s^2]
};

/// The constants that (1)-(2) and the torque are made of, computed once per trial.
template <class Real>
struct PlantConstants {
  Real mass;     ///< [kg] m1 + m2
  Real moment;   ///< [kg m] m2 d2
  Real inertia;  ///< [kg m^2] I2 + m2 d2^2, about the joint axis
  Real f1;       ///< [N s/m]
  Real f2;       ///< [N m s/rad]
};

template <class Real>
PlantConstants<Real> constants_of(const PlantParameters<Real>& p) {
  const Real moment = p.m2 * p.d2;
  return {p.m1 + p.m2, moment, p.I2 + moment * p.d2, p.f1, p.f2};
}

/// K = m2 d2 / (I2 + m2 d2^2) [1/m], the gain of (4).
template <class Real>
Real coupling(const PlantParameters<Real>& p) {
  const PlantConstants<Real> k = constants_of(p);
  return k.moment / k.inertia;
}

/// Generalised forces on the joints.
template <class Real>
struct GeneralisedForces {
  Real force;   ///< [N] on the first joint
  Real torque;  ///< [N m] on the second
};

/// Joint accelerations under the generalised forces that stand to the right of (1) and (2).
///
/// @param coupled  m2 d2 sin q2 [kg m]
template <class Real>
Accelerations<Real> solve_accelerations(const PlantConstants<Real>& k, const Real& coupled, const Real& force,
                                        const Real& torque) {
  const Real reciprocal = Real(1.0) / (k.mass * k.inertia - coupled * coupled);
  return {(force * k.inertia + coupled * torque) * reciprocal, (k.mass * torque + coupled * force) * reciprocal};
}

/// (1)-(2) with viscous friction (§5), solved for the accelerations.
///
/// @param x      state; only the velocities are read
/// @param s, c   sin q2 and cos q2
/// @param tau    [N] force on the first joint
template <class Real>
Accelerations<Real> accelerations(const PlantConstants<Real>& k, const State<Real>& x, const Real& s, const Real& c,
                                  const Real& tau) {
  const Real coupled = k.moment * s;
  const Real force = tau + k.moment * c * (x.q2_dot * x.q2_dot) - k.f1 * x.q1_dot;  // (1)
  const Real torque = -(k.f2 * x.q2_dot);                                           // (2)
  return solve_accelerations(k, coupled, force, torque);
}

/// The same under further forces on both joints, `external`.
template <class Real>
Accelerations<Real> accelerations(const PlantConstants<Real>& k, const State<Real>& x, const Real& s, const Real& c,
                                  const Real& tau, const GeneralisedForces<Real>& external) {
  const Real coupled = k.moment * s;
  const Real force = tau + k.moment * c * (x.q2_dot * x.q2_dot) - k.f1 * x.q1_dot + external.force;  // (1)
  const Real torque = external.torque - k.f2 * x.q2_dot;                                             // (2)
  return solve_accelerations(k, coupled, force, torque);
}

/// Kinetic energy [J], the whole mechanical energy on the horizontal plane.
template <class Real>
Real kinetic_energy(const PlantConstants<Real>& k, const State<Real>& x, const Real& s) {
  const Real half(0.5);
  return half * k.mass * x.q1_dot * x.q1_dot - k.moment * s * x.q1_dot * x.q2_dot +
         half * k.inertia * x.q2_dot * x.q2_dot;
}

/// The force [N] that gives q1'' = a on the plant with constants `k` (§2.1, partial feedback linearisation). The
/// controller calls it with the nominal plant's constants, whatever the true plant is.
///
/// @param a      [m/s^2] acceleration asked of the first joint
/// @param s, c   sin q2 and cos q2
/// @param q2_dot [rad/s]
template <class Real>
Real linearising_force(const PlantConstants<Real>& k, const Real& a, const Real& s, const Real& c, const Real& q2_dot) {
  const Real coupled = k.moment * s;
  return (k.mass - coupled * coupled / k.inertia) * a - k.moment * c * (q2_dot * q2_dot);
}

}  // namespace steerstat
