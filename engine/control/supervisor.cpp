#include "control/supervisor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "control/cycle.hpp"
#include "control/robust_alignment.hpp"
#include "control/robust_policy.hpp"
#include "core/elementary.hpp"
#include "core/function_clones.hpp"

namespace steerstat {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double runaway = 1e3;         // beyond this a state has diverged
constexpr double arrival_slack = 1e-6;  // [rad] a drift that ended at the entry point is in the set
constexpr double time_slack = 1e-12;    // [s] the horizon has come

/// The passive joint seen from the goal's quadrant (CONTROLLER.md section 4).
struct PassiveJoint {
  double u;      // [rad] past the approach edge, in [0, 2 pi)
  double omega;  // [rad/s] towards the goal
  double sine;   // sin q2
  double s2;     // sigma sin 2 q2: a cycle changes omega by -K^2 beta s2 A^2 / T
};

PassiveJoint passive_joint(const State<double>& x, const Goal& goal) {
  const SinCos<double> angle = sincos(x.q2);
  return {modulo_turn(goal.sigma * (x.q2 - goal.edge)), goal.sigma * x.q2_dot, angle.sin,
          goal.sigma * (2.0 * angle.sin * angle.cos)};
}

bool is_finite(const State<double>& x) {
  return std::isfinite(x.q1) && std::isfinite(x.q2) && std::isfinite(x.q1_dot) && std::isfinite(x.q2_dot);
}

bool has_diverged(const State<double>& x, const Goal& goal) {
  return !is_finite(x) || std::abs(x.q1 - goal.q1) > runaway || std::abs(x.q2_dot) > runaway;
}

bool realigns_after(PhaseKind last, Realignment realignment) {
  switch (last) {
    case PhaseKind::contraction:
    case PhaseKind::swing:
      return realignment != Realignment::never;
    case PhaseKind::drift:
      return realignment == Realignment::always;
    case PhaseKind::align:
      return false;
  }
  return false;
}

// What follows fills in a phase that is as it is made: to return one would copy it, which takes as long as to decide.

void set_cycle(PhaseKind kind, double period, double amplitude, Phase& phase) {
  phase.kind = kind;
  phase.duration = period;
  phase.amplitude = amplitude;
}

void align(const State<double>& x, const Controller& controller, const Goal& goal, Phase& phase) {
  if (controller.policy == Policy::robust) {
    phase = align_robustly(x, controller, goal);
    return;
  }
  phase.kind = PhaseKind::align;
  phase.active_tolerance = controller.alignment.tolerance;
}

/// (16): the period of a contraction cycle from here.
double contraction_period(const PassiveJoint& joint, const Controller& controller, const Goal& goal) {
  return (1.0 - controller.contraction.eta1) * (goal.width - joint.u) / joint.omega;
}

/// (17)
void contract(double period, const PassiveJoint& joint, const Controller& controller, Phase& phase) {
  const double gain = controller.coupling * controller.coupling * beta * std::abs(joint.s2);
  const double amplitude = std::sqrt(period * (1.0 - controller.contraction.eta2) * joint.omega / gain);
  set_cycle(PhaseKind::contraction, period, amplitude, phase);
}

/// Rule 5: let the joint turn towards the goal until it is `entry_fraction` into its quadrant (cases T1, T2).
void drift_to_entry(const State<double>& x, const PassiveJoint& joint, const Controller& controller, const Goal& goal,
                    Phase& phase) {
  double distance = controller.entry_fraction * goal.width - joint.u;
  if (distance <= arrival_slack) distance += 2.0 * pi;
  phase.kind = PhaseKind::drift;
  (goal.sigma > 0.0 ? phase.q2_high : phase.q2_low) = x.q2 + goal.sigma * distance;
  phase.direction = goal.sigma;
  phase.speed_floor = 0.99 * controller.rest_speed;
}

/// Rule 6: let the joint turn away from the goal until a swing has authority over it (case T3).
///
/// It ends where s2 = -(min_authority + 0.1); s2 = sin 2v with v = sigma q2 is above that while v lies within
/// half + pi/4 of an odd multiple of pi/4 congruent to pi/4 modulo pi, half = asin(min_authority + 0.1) / 2.
void drift_to_authority(const State<double>& x, const Controller& controller, const Goal& goal, Phase& phase) {
  const double half = 0.5 * arc_sine(controller.swing.min_authority + 0.1) + 0.25 * pi;
  const double v = goal.sigma * x.q2;
  const double centre = 0.25 * pi + pi * std::nearbyint((v - 0.25 * pi) / pi);
  phase.kind = PhaseKind::drift;
  phase.q2_low = goal.sigma * centre - half;
  phase.q2_high = goal.sigma * centre + half;
  phase.direction = -goal.sigma;
  phase.speed_floor = 0.99 * controller.rest_speed;
}

/// Rule 7: change the passive joint's speed towards the wanted one with a cycle (case T3).
void swing(const PassiveJoint& joint, const Controller& controller, Phase& phase) {
  const Controller::Swing& k = controller.swing;
  double change = joint.s2 < 0.0 ? k.speed - joint.omega : k.speed + joint.omega;
  if (change < 0.0) change = k.speed;
  const double gain = controller.coupling * controller.coupling * beta * std::max(1e-6, std::abs(joint.s2));
  set_cycle(PhaseKind::swing, k.period, std::min(k.max_amplitude, std::sqrt(k.period * change / gain)), phase);
}

/// Rules 4-7.
void steer(const State<double>& x, const PassiveJoint& joint, const Controller& controller, const Goal& goal,
           Phase& phase) {
  const double entry = controller.entry_fraction * goal.width - arrival_slack;
  const bool inside = joint.omega > 0.0 && entry <= joint.u && joint.u < goal.width;
  if (inside) {  // rule 4
    const double period = contraction_period(joint, controller, goal);
    if (period <= controller.contraction.max_period) return contract(period, joint, controller, phase);
  }
  const double authority = controller.swing.min_authority;
  const bool too_slow = joint.omega < controller.drift.min_speed && joint.s2 < -authority;
  if (joint.omega > controller.rest_speed && !inside && !too_slow) {
    return drift_to_entry(x, joint, controller, goal, phase);  // rule 5
  }
  if (joint.omega < -controller.rest_speed && joint.s2 > -authority) {
    return drift_to_authority(x, controller, goal, phase);  // rule 6
  }
  swing(joint, controller, phase);  // rule 7
}

void note(const Phase& phase, Memory& memory) {
  memory.last = phase.kind;
  switch (phase.kind) {
    case PhaseKind::align:
      ++memory.alignments;
      memory.pace = phase.pace;
      break;
    case PhaseKind::contraction:
      ++memory.cycles;
      break;
    case PhaseKind::swing:
      ++memory.swings;
      break;
    case PhaseKind::drift:
      break;
  }
}

}  // namespace

STEERSTAT_CLONED
std::optional<Status> decide(double t, const State<double>& x, const Controller& controller, const Goal& goal,
                             Memory& memory, Phase& phase) {
  phase = Phase{};
  const auto run_align = [&] {
    align(x, controller, goal, phase);
    note(phase, memory);
    return std::optional<Status>{};
  };
  // Only asked where the answer counts: it waits for a square root.
  const auto aligned = [&] { return active_error(x, goal) <= controller.alignment.tolerance; };
  const bool late = t >= controller.horizon - time_slack;
  // Every trial starts with align. An align that is skipped, or has no time left, counts as one that ended at once.
  if (!memory.last && !late && is_finite(x) && !aligned()) return run_align();

  if (has_diverged(x, goal)) return Status::diverged;
  if (late || memory.decisions >= most_decisions) return Status::timeout;  // rule 1
  const bool robust = controller.policy == Policy::robust;
  const Realignment realignment = robust ? Realignment::after_cycle : controller.realignment;
  if (memory.last && realigns_after(*memory.last, realignment) && !aligned()) return run_align();

  ++memory.decisions;
  // This counts as a decision, so that a trial whose aligns are cut again and again ends.
  const bool cut = robust && memory.last == PhaseKind::align && !aligned();
  if (cut && aligns_too_fast(x, memory.pace, controller, goal)) return run_align();
  if (robust) learn(x, controller, goal, memory.experience);
  // The speed alone mostly tells, before the wrapped angle is there.
  const double tolerance = controller.convergence.tolerance;
  if (std::abs(x.q2_dot) <= tolerance && passive_error(x, goal) <= tolerance) {  // rule 2
    if (active_error(x, goal) <= controller.convergence.active_tolerance) return Status::converged;
    return run_align();
  }
  const PassiveJoint joint = passive_joint(x, goal);
  if (std::abs(joint.sine) <= 1e-6 && std::abs(x.q2_dot) <= 1e-6) return Status::singular;  // rule 3
  if (robust) {
    phase = steer_robustly(x, memory.experience, controller, goal);
    embark(phase, x, memory.experience);
  } else {
    steer(x, joint, controller, goal, phase);
  }
  note(phase, memory);
  return std::nullopt;
}

}  // namespace steerstat
