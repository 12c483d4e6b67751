#include "control/robust_alignment.hpp"

#include <cmath>

namespace steerstat {
namespace {

constexpr double first_share = 0.9;  // of the bound on |a|, at most, where an align starts
constexpr double last_share = 0.95;  // of it, where an align that has ended goes on at a slower pace

/// Share of the bound on |a| at which an align ends: what locating the moment and measuring the peak may miss is less.
constexpr double highest_ceiling = 1.0 - 1e-6;

/// |a| of (10) at full pace is at most the sum of these [m/s^2]; the first goes with the square of the pace, the second
/// with the pace.
struct AlignmentTerms {
  double stiffness, damping;
};

AlignmentTerms alignment_terms(const State<double>& x, const Controller& controller, const Goal& goal) {
  return {controller.alignment.kp * std::abs(x.q1 - goal.q1), controller.alignment.kd * std::abs(x.q1_dot)};
}

}  // namespace

Phase align_robustly(const State<double>& x, const Controller& controller, const Goal& goal) {
  Phase phase;
  phase.kind = PhaseKind::align;
  phase.active_tolerance = controller.alignment.tolerance;
  phase.ceiling = highest_ceiling * controller.robust.max_acceleration;
  const auto [stiffness, damping] = alignment_terms(x, controller, goal);
  const double start = first_share * controller.robust.max_acceleration;
  if (stiffness + damping > start) {  // at this pace they add up to it
    phase.pace = 2.0 * start / (damping + std::sqrt(damping * damping + 4.0 * stiffness * start));
  }
  phase.duration = controller.alignment.max_duration / phase.pace;
  return phase;
}

bool aligns_too_fast(const State<double>& x, double pace, const Controller& controller, const Goal& goal) {
  const auto [stiffness, damping] = alignment_terms(x, controller, goal);
  return pace * (pace * stiffness + damping) > last_share * controller.robust.max_acceleration;
}

}  // namespace steerstat
