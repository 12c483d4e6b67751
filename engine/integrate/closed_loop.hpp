#pragma once

#include <array>
#include <cmath>

#include "control/cycle.hpp"
#include "control/phase.hpp"
#include "core/state.hpp"
#include "robot/actuator.hpp"
#include "robot/disturbance.hpp"
#include "robot/plant.hpp"

namespace steerstat {

/// The plant under its controller, between two decisions: what every integrator advances and what replay reports.
///
/// @tparam Real  double, or any number type with the field operations and comparisons.
template <class Real>
struct ClosedLoop {
  PlantConstants<Real> plant;    ///< what is true
  PlantConstants<Real> nominal;  ///< what the controller believes
  Real kp;                       ///< [1/s^2] of (10)
  Real kd;                       ///< [1/s] of (10)
  Real q1_goal;                  ///< [m]
  Disturbance<Real> disturbance{};
  Actuator<Real> actuator{};
};

/// The gains of (10).
template <class Real>
struct AlignGains {
  Real kp;  ///< [1/s^2]
  Real kd;  ///< [1/s]
};

/// The gains at an align's pace. (Inlined everywhere: kernels share no function with other sources; see
/// core/instruction_set.hpp.)
template <class Real>
[[gnu::always_inline]] inline AlignGains<Real> align_gains(const ClosedLoop<Real>& loop, const Phase& align) {
  return {loop.kp * Real(align.pace * align.pace), loop.kd * Real(align.pace)};
}

/// (10) at the phase's pace, of what is read of the first joint. @return a [m/s^2]
template <class Real>
Real align_acceleration(const ClosedLoop<Real>& loop, const Phase& phase, const State<Real>& x) {
  const auto [kp, kd] = align_gains(loop, phase);
  return kp * (loop.q1_goal - (x.q1 + Real(phase.q1_offset))) - kd * (x.q1_dot + Real(phase.q1_dot_offset));
}

/// The acceleration a [m/s^2] that `phase` asks of the first joint: (10), 0 or (11).
///
/// @param t  [s] since the phase's start
template <class Real>
Real commanded_acceleration(const ClosedLoop<Real>& loop, const Phase& phase, const Real& t, const State<Real>& x) {
  switch (phase.kind) {
    case PhaseKind::align:
      return align_acceleration(loop, phase, x);
    case PhaseKind::drift:
      return Real(0.0);
    case PhaseKind::contraction:
    case PhaseKind::swing:
      return cycle_acceleration(Real(phase.amplitude), Real(phase.duration), t);
  }
  return Real(0.0);
}

/// The force [N] that the controller asks the actuator for, by the nominal plant.
///
/// @param s, c  sin q2 and cos q2
template <class Real>
Real demanded_force(const ClosedLoop<Real>& loop, const Real& a, const State<Real>& x, const Real& s, const Real& c) {
  return linearising_force(loop.nominal, a, s, c, x.q2_dot);
}

/// The force [N] on the first joint of the true plant.
template <class Real>
Real driving_force(const ClosedLoop<Real>& loop, const Real& a, const State<Real>& x, const Real& s, const Real& c) {
  return applied_force(loop.actuator, demanded_force(loop, a, x, s, c));
}

/// dx/dt under the acceleration a: the true plant, driven by the force that the nominal one would need.
///
/// @param s, c  sin q2 and cos q2
/// @return the time derivative of each field of x
template <class Real>
State<Real> derivative(const ClosedLoop<Real>& loop, const Real& a, const State<Real>& x, const Real& s,
                       const Real& c) {
  const Real tau = driving_force(loop, a, x, s, c);
  const Accelerations<Real> ddot =
      is_present(loop.disturbance)
          ? accelerations(loop.plant, x, s, c, tau, disturbing_forces(loop.plant, loop.disturbance, x, s, c))
          : accelerations(loop.plant, x, s, c, tau);
  return {x.q1_dot, x.q2_dot, ddot.q1_ddot, ddot.q2_ddot};
}

/// How many guards a phase has, used or not.
inline constexpr std::size_t guard_count = 5;

/// The guards of `phase` as functions of the state; positive where they hold off, infinite where unused.
///
/// @return (guard_count) the active error [m, m/s], q2 above its low bound [rad], q2 below its high bound [rad], the
///         speed above its floor [rad/s], and |a| below its ceiling [m/s^2]; see Phase for when they fire
inline std::array<double, guard_count> guards(const ClosedLoop<double>& loop, const Phase& phase,
                                              const State<double>& x) {
  const double e = x.q1 + phase.q1_offset - loop.q1_goal;
  const double v = x.q1_dot + phase.q1_dot_offset;
  const double active =
      phase.active_tolerance < 0.0 ? Phase::unbounded : std::sqrt(e * e + v * v) - phase.active_tolerance;
  const double below =
      phase.ceiling < Phase::unbounded ? phase.ceiling - std::abs(align_acceleration(loop, phase, x)) : phase.ceiling;
  return {active, x.q2 - phase.q2_low, phase.q2_high - x.q2, phase.direction * x.q2_dot - phase.speed_floor, below};
}

}  // namespace steerstat
