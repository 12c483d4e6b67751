#include "trial/supervision.hpp"

namespace steerstat {
namespace {

/// Restates a phase whose law and guards are of readings that are `error` above the state in terms of the state.
void correct(Phase& phase, const State<double>& error) {
  if (phase.kind == PhaseKind::align) {
    phase.q1_offset = error.q1;
    phase.q1_dot_offset = error.q1_dot;
  }
  phase.q2_low -= error.q2;
  phase.q2_high -= error.q2;
  phase.speed_floor -= phase.direction * error.q2_dot;
}

}  // namespace

std::optional<Status> Supervision::decide(const TrialParameters& trial, double t, const State<double>& x,
                                          Phase& phase) {
  if (trial.sensor.is_exact()) return steerstat::decide(t, x, trial.controller, trial.goal, memory_, phase);
  const State<double> error = trial.sensor.error(readings_++);
  const auto outcome = steerstat::decide(t, reading(x, error), trial.controller, trial.goal, memory_, phase);
  if (!outcome) correct(phase, error);
  return outcome;
}

}  // namespace steerstat
