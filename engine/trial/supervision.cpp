#include "trial/supervision.hpp"

namespace steerstat {
namespace {

/// `phase`, whose law and guards are of readings that are `error` above the state, in terms of the state.
Phase corrected(Phase phase, const State<double>& error) {
  if (phase.kind == PhaseKind::align) {
    phase.q1_offset = error.q1;
    phase.q1_dot_offset = error.q1_dot;
  }
  phase.q2_low -= error.q2;
  phase.q2_high -= error.q2;
  phase.speed_floor -= phase.direction * error.q2_dot;
  return phase;
}

}  // namespace

Decision Supervision::decide(const TrialParameters& trial, double t, const State<double>& x) {
  const auto ask = [&](const State<double>& read) {
    return steerstat::decide(t, read, memory_, trial.controller, trial.goal);
  };
  Decision decision;
  if (trial.sensor.is_exact()) {
    decision = ask(x);
  } else {
    const State<double> error = trial.sensor.error(readings_++);
    decision = ask(reading(x, error));
    decision.phase = corrected(decision.phase, error);
  }
  memory_ = decision.memory;
  return decision;
}

}  // namespace steerstat
