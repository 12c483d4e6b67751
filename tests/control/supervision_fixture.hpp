#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "control/supervisor.hpp"

/// What the tests of the paper's policy, CONTROLLER.md section 5, stand on.
namespace steerstat::testing {

inline constexpr double pi = std::numbers::pi;
inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

inline double above(double x) {
  return std::nextafter(x, infinity);
}
inline double below(double x) {
  return std::nextafter(x, -infinity);
}

/// A controller, the paper's goal, and what the supervisor decides with them.
struct Supervision {
  Controller controller{};
  Goal goal{goal_at(0.0, pi / 4)};

  /// At the end of a phase of the kind `last`.
  Decision after(PhaseKind last, const State<double>& x, double t = 1.0) const {
    return decide(t, x, Memory{last}, controller, goal);
  }

  /// At the trial's start.
  Decision first(const State<double>& x) const { return decide(0.0, x, Memory{}, controller, goal); }

  /// The phase that rules 4-7 choose for an aligned robot.
  Phase steer(double q2, double q2_dot) const {
    const Decision decision = after(PhaseKind::align, {0.0, q2, 0.0, q2_dot});
    EXPECT_FALSE(decision.outcome.has_value()) << q2 << ' ' << q2_dot;
    return decision.phase;
  }
};

inline void expect_stops(const Decision& decision, Status status) {
  ASSERT_TRUE(decision.outcome.has_value()) << "runs " << name_of(decision.phase.kind);
  EXPECT_EQ(*decision.outcome, status) << name_of(*decision.outcome);
}

inline void expect_runs(const Decision& decision, PhaseKind kind) {
  ASSERT_FALSE(decision.outcome.has_value()) << "stops, " << name_of(*decision.outcome);
  EXPECT_EQ(decision.phase.kind, kind) << name_of(decision.phase.kind);
}

inline constexpr State<double> swinging_state{0.0, -0.6, 0.0, 0.0};  // at rest, off the axes: rule 7

}  // namespace steerstat::testing
