#pragma once

#include <cstddef>
#include <functional>
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

/// Where a phase of a trajectory stands.
struct PhaseSpan {
  PhaseKind kind;
  std::size_t first;  ///< its first sample
  std::size_t last;   ///< its last sample, that of its end
  bool whole;         ///< whether it ended as it should, neither at the horizon nor because the integration failed
};

/// A trial's whole course.
struct Trajectory {
  /// In time order; every phase contributes its start and its end (so boundaries appear twice, once a phase) and the
  /// multiples of the sampling interval between them.
  std::vector<TrajectorySample> samples;
  TrialOutcome outcome;           ///< the same bits as the run's
  std::vector<PhaseSpan> phases;  ///< in time order
};

/// Recomputes a trial with its trajectory.
///
/// @param interval   [s] > 0 between samples inside a phase
/// @param per_cycle  where positive, samples of a cycle are no farther apart than its period over this many: cycles may
///                   be shorter than the interval
/// @param check_in   called every few milliseconds; what it throws ends the replay
Trajectory replay(const TrialParameters& parameters, const IntegratorChoice& integrator, double interval = 0.05,
                  int per_cycle = 0, const std::function<void()>& check_in = {});

/// Whether a trial recomputed `now` ended in the same bits as `then`, but for metrics that `then` does not have: files
/// from before there were metrics hold none.
bool bears_out(const TrialOutcome& now, const TrialOutcome& then);

}  // namespace steerstat
