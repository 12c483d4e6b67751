#pragma once

#include <vector>

#include "control/phase.hpp"
#include "trial/runner.hpp"
#include "trial/trial.hpp"

namespace steerstat {

/// One moment of a trajectory.
struct TrajectorySample {
  double t;  ///< [s]
  State<double> state;
  double a;         ///< [m/s^2] acceleration the controller asks of the first joint
  double tau;       ///< [N] force on the first joint, as the actuator applies it
  PhaseKind phase;  ///< the phase under way
};

/// A trial's whole course.
struct Trajectory {
  /// In time order; every phase contributes its start and its end (so boundaries appear twice, once a phase) and the
  /// multiples of the sampling interval between them.
  std::vector<TrajectorySample> samples;
  TrialOutcome outcome;  ///< the same bits as the run's
};

/// Recomputes a trial with its trajectory.
///
/// @param interval  [s] > 0 between samples inside a phase
Trajectory replay(const TrialParameters& parameters, const IntegratorChoice& integrator, double interval = 0.05);

}  // namespace steerstat
