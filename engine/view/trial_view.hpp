#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "trial/replay.hpp"
#include "view/viewed_study.hpp"

namespace steerstat {

/// A trial's trajectory is shown in at most this many points.
inline constexpr std::size_t most_trajectory_points = 2'000;

/// At most this many phases of a trial are listed.
inline constexpr std::size_t most_listed_phases = 300;

/// One contraction cycle that ran its whole period. The robust policy's goes on to the end of an align that
/// follows: by then the policy wants the speed to be r times the distance to go.
struct ContractionCycle {
  double start, end;                       ///< [s]
  double distance_before, distance_after;  ///< [rad] distance to go e = w - u (CONTROLLER.md section 4), not wrapped
  double distance_predicted;               ///< [rad] by (14), or what the robust policy aimed at
  double speed_before, speed_after;        ///< [rad/s] omega = sigma q2_dot
  double speed_predicted;                  ///< [rad/s] by (15), or what the robust policy aimed at
  double passive_error_after;              ///< rad + rad/s
};

/// What the page shows of a trial (schemas/view.schema.json, `trial`).
struct TrialView {
  StudyIdentity study;
  std::uint64_t index{0};
  std::uint64_t cell{0};
  TrialParameters parameters;
  std::vector<std::string> varying;  ///< inputs that vary in the study
  TrialOutcome outcome;
  std::size_t of{0};                      ///< samples that `samples` were chosen from
  double largest_deviation{0.0};          ///< see Thinned
  std::vector<TrajectorySample> samples;  ///< with the ends of every phase listed
  std::size_t phases_of{0};               ///< how many phases there are
  std::vector<PhaseSpan> phases;          ///< the first ones, in terms of `samples`
  std::vector<ContractionCycle> cycles;   ///< of the phases listed
  double q1_low{0.0}, q1_high{0.0};       ///< [m] over the whole course
};

/// Replays a trial finely enough to draw it: 20 samples a second, and 32 at least within each cycle.
/// @param check_in  as replay() takes it
Trajectory replay_for_view(const TrialParameters& parameters, const IntegratorChoice& integrator,
                           const std::function<void()>& check_in = {});

/// @param index       of the trial
/// @param parameters  its own
/// @param trajectory  its own, with its samples
/// @param points      shown at most, >= 8
TrialView trial_view(const Study& study, std::uint64_t index, const TrialParameters& parameters,
                     const Trajectory& trajectory, std::size_t points = most_trajectory_points);

/// The view as JSON (schemas/view.schema.json), ending in a newline.
std::string trial_view_json(const TrialView& view);

}  // namespace steerstat
