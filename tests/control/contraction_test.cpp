#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "control/cycle.hpp"
#include "control/supervisor.hpp"
#include "robot/nilpotent.hpp"

/// The contraction formulas (16)-(17), as the supervisor applies them, on the approximation they were derived from.
namespace steerstat {
namespace {

constexpr PolynomialCommand command(cycle_coefficients);

/// Relative rounding error of the closed form at T in doubles: coefficients whose sizes add up to 340 cancel to -2
/// beta.
constexpr double closed_form_error = 340.0 / (2.0 * beta) * 0x1p-52;

/// What the supervisor runs from an aligned state.
Phase phase_from(const State<double>& x, const Controller& controller, const Goal& goal) {
  const Decision decision = decide(1.0, x, Memory{PhaseKind::align}, controller, goal);
  EXPECT_FALSE(decision.outcome.has_value());
  return decision.phase;
}

struct Change {
  double q2;
  double q2_dot;
};

/// What a cycle does to the passive joint of the nilpotent approximation (9).
Change change_on_approximation(const State<double>& x, double coupling, const Phase& cycle) {
  const RegularPoint<double> x0{x.q1, x.q2, x.q2_dot, std::sin(x.q2), std::cos(x.q2), coupling};
  const State<double> end =
      state_at(x0, nilpotent_response(x0, command, cycle.amplitude, cycle.duration, cycle.duration));
  return {end.q2 - x.q2, end.q2_dot - x.q2_dot};
}

TEST(Contraction, ReachesTheRatesOf14And15OnTheApproximationInEveryQuadrant) {
  for (const double q2_goal : {std::numbers::pi / 4, 2.2, -2.4, -0.6}) {
    const Goal goal = goal_at(0.0, q2_goal);
    for (const double eta1 : {0.3, 0.5, 0.9}) {
      for (const double eta2 : {0.2, 0.6, 0.8}) {
        Controller controller;
        controller.contraction.eta1 = eta1;
        controller.contraction.eta2 = eta2;
        const double error = goal.sigma * 0.3 * goal.width;
        const State<double> x{0.0, q2_goal - error, 0.0, goal.sigma * 0.05};
        const Phase phase = phase_from(x, controller, goal);
        ASSERT_EQ(phase.kind, PhaseKind::contraction) << q2_goal;
        const Change change = change_on_approximation(x, controller.coupling, phase);
        EXPECT_NEAR(change.q2, (1.0 - eta1) * error, 1e-12);                            // (14)
        EXPECT_NEAR(change.q2_dot, (eta2 - 1.0) * x.q2_dot, closed_form_error * 0.05);  // (15)
      }
    }
  }
}

TEST(Contraction, UsesTheCouplingTheControllerBelievesIn) {
  const Goal goal = goal_at(0.0, std::numbers::pi / 4);
  const State<double> x{0.0, 0.5, 0.0, 0.05};
  Controller controller;
  const double amplitude = phase_from(x, controller, goal).amplitude;
  controller.coupling = 0.8;
  EXPECT_NEAR(phase_from(x, controller, goal).amplitude, amplitude / 2.0, 1e-12);
}

TEST(Swing, ReachesTheWantedSpeedOnTheApproximation) {
  // From quadrant IV with q2_dot < 0 towards a goal in quadrant I (case T3), where sin 2 q2 < 0.
  const Goal goal = goal_at(0.0, std::numbers::pi / 4);
  Controller controller;
  controller.swing.max_amplitude = 1000.0;
  const State<double> x{0.0, -0.8, 0.0, -0.05};
  const Phase phase = phase_from(x, controller, goal);
  ASSERT_EQ(phase.kind, PhaseKind::swing);
  EXPECT_EQ(phase.duration, controller.swing.period);
  const Change change = change_on_approximation(x, controller.coupling, phase);
  EXPECT_NEAR(x.q2_dot + change.q2_dot, controller.swing.speed, closed_form_error * 0.25);
}

TEST(Swing, TowardsAGoalInQuadrant2ReachesTheWantedSpeedBackwards) {
  const Goal goal = goal_at(0.0, 2.2);
  Controller controller;
  controller.swing.max_amplitude = 1000.0;
  const State<double> x{0.0, 0.8, 0.0, 0.05};
  const Phase phase = phase_from(x, controller, goal);
  ASSERT_EQ(phase.kind, PhaseKind::swing);
  const Change change = change_on_approximation(x, controller.coupling, phase);
  EXPECT_NEAR(x.q2_dot + change.q2_dot, -controller.swing.speed, closed_form_error * 0.25);
}

TEST(Swing, IsNoLargerThanTheLargestAmplitude) {
  const State<double> x{0.0, -0.8, 0.0, -0.05};
  EXPECT_EQ(phase_from(x, Controller{}, goal_at(0.0, std::numbers::pi / 4)).amplitude,
            Controller{}.swing.max_amplitude);
}

}  // namespace
}  // namespace steerstat
