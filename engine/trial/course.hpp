#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "integrate/arrival.hpp"
#include "integrate/closed_loop.hpp"
#include "integrate/exertion.hpp"
#include "integrate/lockstep_engine.hpp"
#include "trial/contraction_record.hpp"
#include "trial/supervision.hpp"
#include "trial/trial.hpp"

namespace steerstat {

/// The closed loop of a trial.
inline ClosedLoop<double> closed_loop_of(const TrialParameters& parameters) {
  const Controller::Alignment& alignment = parameters.controller.alignment;
  return {constants_of(parameters.plant),
          constants_of(parameters.nominal),
          alignment.kp,
          alignment.kd,
          parameters.goal.q1,
          parameters.disturbance,
          parameters.actuator};
}

/// Which lockstep engine a trial goes to. Its own parameters say so, and nothing else, lest its bits depend on others.
inline LoopKind loop_kind_of(const TrialParameters& parameters) {
  const bool ideal =
      !is_present(parameters.disturbance) && parameters.actuator == Actuator<double>{} && parameters.sensor.is_exact();
  return ideal ? LoopKind::ideal : LoopKind::imperfect;
}

/// What a trial reports that ended with `status` in state x at time t, whatever the supervisor read there.
inline TrialOutcome outcome_of(Status status, double t, const State<double>& x, const Memory& memory,
                               const ContractionRecord& contraction, const Goal& goal) {
  TrialOutcome outcome{status, memory.cycles,          memory.swings,        memory.alignments, t,
                       x,      passive_error(x, goal), active_error(x, goal)};
  outcome.position_contraction = contraction.position();
  outcome.velocity_contraction = contraction.velocity();
  return outcome;
}

/// Reports what a trial's course asked of the first joint; nothing of what is not finite.
inline void report_exertion(const Exertion& exertion, TrialOutcome& outcome) {
  const auto finite = [](double x) { return std::isfinite(x) ? x : no_value; };
  outcome.effort = finite(exertion.effort);
  outcome.peak_acceleration = finite(exertion.peak_acceleration);
  outcome.peak_force = finite(exertion.peak_force);
  outcome.peak_stroke = finite(exertion.peak_stroke);
}

/// Whether a trial has gone beyond its stroke limit (controller.max_stroke). Judged at its start and whenever a phase
/// has ended, it has diverged then.
///
/// @param exertion  measured up to there
inline bool exceeds_stroke(const TrialParameters& parameters, const Exertion& exertion) {
  return exertion.peak_stroke > parameters.controller.max_stroke;
}

/// Runs one trial, phase by phase, as CONTROLLER.md section 5 says.
///
/// @param exertion  of the trial so far, which `advance` keeps up to date; the start's where none is measured
/// @param advance  (const Phase&, double t, const State<double>& x, double t_end) -> Arrival, the integrator
template <class Advance>
TrialOutcome run_course(const TrialParameters& parameters, const Exertion& exertion, Advance&& advance) {
  const Goal& goal = parameters.goal;
  double t = 0.0;
  State<double> x = parameters.start;
  Supervision supervision;
  ContractionRecord contraction;
  Phase phase;
  while (true) {
    if (exceeds_stroke(parameters, exertion)) {
      return outcome_of(Status::diverged, t, x, supervision.memory(), contraction, goal);
    }
    const std::optional<Status> ended = supervision.decide(parameters, t, x, phase);
    if (ended) return outcome_of(*ended, t, x, supervision.memory(), contraction, goal);
    contraction.start(phase, t, x, goal, parameters.controller.horizon);
    const double t_end = std::min(t + phase.duration, parameters.controller.horizon);
    const Arrival arrival = advance(phase, t, x, t_end);
    t = arrival.t;
    x = arrival.state;
    if (arrival.cause == Cause::failure) {
      return outcome_of(Status::integrator_failed, t, x, supervision.memory(), contraction, goal);
    }
    contraction.finish(x, goal);
  }
}

}  // namespace steerstat
