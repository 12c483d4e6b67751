#pragma once

#include <algorithm>

#include "control/supervisor.hpp"
#include "integrate/arrival.hpp"
#include "integrate/closed_loop.hpp"
#include "trial/trial.hpp"

namespace steerstat {

/// The closed loop of a trial.
inline ClosedLoop<double> closed_loop_of(const TrialParameters& parameters) {
  const Controller::Alignment& alignment = parameters.controller.alignment;
  return {constants_of(parameters.plant), constants_of(parameters.nominal), alignment.kp, alignment.kd,
          parameters.goal.q1};
}

/// What a trial reports that ended with `status` in state x at time t.
inline TrialOutcome outcome_of(Status status, double t, const State<double>& x, const Memory& memory,
                               const Goal& goal) {
  return {status, memory.cycles, memory.swings, memory.alignments, t, x, passive_error(x, goal), active_error(x, goal)};
}

/// Runs one trial, phase by phase, as CONTROLLER.md section 5 says.
///
/// @param advance  (const Phase&, double t, const State<double>& x, double t_end) -> Arrival, the integrator
template <class Advance>
TrialOutcome run_course(const TrialParameters& parameters, Advance&& advance) {
  const auto& [nominal, plant, start, goal, controller] = parameters;
  double t = 0.0;
  State<double> x = start;
  Memory memory;
  while (true) {
    const Decision decision = decide(t, x, memory, controller, goal);
    memory = decision.memory;
    if (decision.outcome) return outcome_of(*decision.outcome, t, x, memory, goal);
    const double t_end = std::min(t + decision.phase.duration, controller.horizon);
    const Arrival arrival = advance(decision.phase, t, x, t_end);
    t = arrival.t;
    x = arrival.state;
    if (arrival.cause == Cause::failure) return outcome_of(Status::integrator_failed, t, x, memory, goal);
  }
}

}  // namespace steerstat
