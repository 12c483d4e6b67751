#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "combined_study.hpp"
#include "every_method.hpp"
#include "trial/contraction_record.hpp"
#include "trial/replay.hpp"

/// The contraction ratios that a trial reports.
namespace steerstat::testing {
namespace {

constexpr double pi = std::numbers::pi;

Phase contraction_of(double period) {
  Phase phase;
  phase.kind = PhaseKind::contraction;
  phase.duration = period;
  phase.amplitude = 1.0;
  return phase;
}

/// The goal is pi/4, in quadrant I: e = pi/4 - q2 and omega = q2_dot.
const Goal goal = goal_at(0.0, pi / 4);

State<double> short_of_the_goal(double e, double omega) {
  return {0.0, pi / 4 - e, 0.0, omega};
}

TEST(ContractionRecord, HasNoRatiosBeforeACycleHasFinished) {
  ContractionRecord record;
  EXPECT_TRUE(std::isnan(record.position().mean));
  record.start(contraction_of(2.0), 10.0, short_of_the_goal(0.2, 0.1), goal, 300.0);
  EXPECT_TRUE(std::isnan(record.position().mean));
  EXPECT_TRUE(std::isnan(record.velocity().worst));
}

TEST(ContractionRecord, TakesMeansAndTheRatiosOfLargestMagnitude) {
  ContractionRecord record;
  const auto cycle = [&](double e0, double omega0, double e1, double omega1) {
    record.start(contraction_of(2.0), 0.0, short_of_the_goal(e0, omega0), goal, 300.0);
    record.finish(short_of_the_goal(e1, omega1), goal);
  };
  cycle(0.2, 0.1, 0.1, 0.06);
  cycle(0.1, 0.08, 0.025, 0.02);
  cycle(0.3, 0.05, -0.24, -0.0375);  // beyond the goal, and turning back
  EXPECT_NEAR(record.position().mean, (0.5 + 0.25 - 0.8) / 3.0, 1e-13);
  EXPECT_NEAR(record.position().worst, -0.8, 1e-13);
  EXPECT_NEAR(record.velocity().mean, (0.6 + 0.25 - 0.75) / 3.0, 1e-13);
  EXPECT_NEAR(record.velocity().worst, -0.75, 1e-13);
}

TEST(ContractionRecord, CountsACycleThatEndsWithTheHorizonAndNoneThatItCuts) {
  for (const bool cut : {false, true}) {
    ContractionRecord record;
    record.start(contraction_of(2.0), 8.0, short_of_the_goal(0.2, 0.1), goal, cut ? std::nextafter(10.0, 0.0) : 10.0);
    record.finish(short_of_the_goal(0.1, 0.05), goal);
    EXPECT_EQ(std::isnan(record.position().mean), cut);
    EXPECT_EQ(std::isnan(record.velocity().mean), cut);
  }
}

TEST(ContractionRecord, CountsContractionCyclesAlone) {
  ContractionRecord record;
  for (const PhaseKind kind : {PhaseKind::align, PhaseKind::drift, PhaseKind::swing}) {
    Phase phase = contraction_of(2.0);
    phase.kind = kind;
    record.start(phase, 0.0, short_of_the_goal(0.2, 0.1), goal, 300.0);
    record.finish(short_of_the_goal(0.1, 0.05), goal);
  }
  EXPECT_TRUE(std::isnan(record.position().mean));
}

TEST(ContractionRecord, FollowsTheDistanceWithoutJumpsOfATurn) {
  ContractionRecord record;  // back behind the approach edge, where u begins anew at 2 pi
  record.start(contraction_of(2.0), 0.0, short_of_the_goal(0.3, 0.1), goal, 300.0);
  record.finish(short_of_the_goal(pi / 4 + 0.1, -0.2), goal);
  EXPECT_NEAR(record.position().mean, (pi / 4 + 0.1) / 0.3, 1e-13);

  ContractionRecord turned;  // on another turn than the goal's, in quadrant II, where sigma = -1
  const Goal second = goal_at(0.0, 3.0 * pi / 4);
  turned.start(contraction_of(2.0), 0.0, {0.0, 3.0 * pi / 4 + 0.2 - 4.0 * pi, 0.0, -0.1}, second, 300.0);
  turned.finish({0.0, 3.0 * pi / 4 + 0.05 - 4.0 * pi, 0.0, -0.03}, second);
  EXPECT_NEAR(turned.position().mean, 0.25, 1e-12);
  EXPECT_NEAR(turned.velocity().mean, 0.3, 1e-13);
}

TEST(ContractionRecord, LeavesOutACycleWhoseEndIsNotFinite) {
  ContractionRecord record;
  record.start(contraction_of(2.0), 0.0, short_of_the_goal(0.2, 0.1), goal, 300.0);
  record.finish({0.0, no_value, 0.0, 0.1}, goal);
  EXPECT_TRUE(std::isnan(record.position().mean));
}

class Contraction : public EveryMethod {};

/// A trial on the nominal plant that begins with a contraction cycle `e` before the goal, whose amplitude vanishes with
/// `loss` = 1 - eta2; the horizon cuts the next.
TrialParameters one_cycle(double e, double loss) {
  TrialParameters trial;
  const double omega = 0.1 * e;
  trial.start = short_of_the_goal(e, omega);
  trial.controller.realignment = Realignment::never;
  trial.controller.convergence.tolerance = 1e-12;
  trial.controller.contraction.eta1 = 0.35;
  trial.controller.contraction.eta2 = 1.0 - loss;
  trial.controller.horizon = 0.65 * e / omega + 1e-9;  // (16)
  return trial;
}

TEST_P(Contraction, IsThatOfEta1AndEta2InTheLimitOfSmallCycles) {
  for (const double loss : {0.2, 0.02, 0.002}) {
    const TrialOutcome outcome = run(one_cycle(1e-3, loss));
    EXPECT_EQ(outcome.position_contraction.worst, outcome.position_contraction.mean);
    EXPECT_EQ(outcome.velocity_contraction.worst, outcome.velocity_contraction.mean);
    // On its way the joint has lost half of the speed it loses, which (16) leaves out.
    EXPECT_NEAR(outcome.position_contraction.mean, 0.35 + 0.65 * 0.5 * loss, 0.02 * loss);
    EXPECT_NEAR(1.0 - outcome.velocity_contraction.mean, loss, 0.02 * loss);
  }
}

TEST_P(Contraction, MissesEta2ByLessTheNearerTheGoal) {
  double last = 1.0;
  for (const double e : {0.1, 0.01, 1e-3}) {
    const double miss = std::abs(run(one_cycle(e, 0.2)).velocity_contraction.mean - 0.8);
    EXPECT_LT(miss, 0.3 * last) << e;
    last = miss;
  }
}

TEST_P(Contraction, IsThatOfTheTrajectorysCycles) {
  for (const TrialParameters& trial : combined_study(25)) {
    const Trajectory trajectory = replay(trial, integrator(), 1e3);
    std::vector<double> positions;
    std::vector<double> velocities;
    for (std::size_t i = 0; i + 1 < trajectory.samples.size(); ++i) {
      const TrajectorySample& start = trajectory.samples[i];
      const TrajectorySample& end = trajectory.samples[i + 1];
      // Rows are the starts and the ends of phases; where there is a row between, it is of the same phase.
      if (start.phase != PhaseKind::contraction || end.t == start.t || end.t == trial.controller.horizon) continue;
      const double e = wrap(trial.goal.q2 - start.state.q2);
      positions.push_back((e - (end.state.q2 - start.state.q2)) / e);
      velocities.push_back(end.state.q2_dot / start.state.q2_dot);
    }
    const TrialOutcome& outcome = trajectory.outcome;
    ASSERT_EQ(positions.empty(), std::isnan(outcome.position_contraction.mean));
    if (positions.empty()) continue;
    const auto mean = [](const std::vector<double>& x) {
      double sum = 0.0;
      for (const double y : x) sum += y;
      return sum / static_cast<double>(x.size());
    };
    const auto worst = [](const std::vector<double>& x) {
      double largest = 0.0;
      for (const double y : x) largest = std::abs(y) >= std::abs(largest) ? y : largest;
      return largest;
    };
    EXPECT_NEAR(outcome.position_contraction.mean, mean(positions), 1e-9);
    EXPECT_NEAR(outcome.position_contraction.worst, worst(positions), 1e-9);
    EXPECT_NEAR(outcome.velocity_contraction.mean, mean(velocities), 1e-12);
    EXPECT_EQ(outcome.velocity_contraction.worst, worst(velocities));
  }
}

INSTANTIATE_TEST_SUITE_P(, Contraction, every_method(), method_name);

}  // namespace
}  // namespace steerstat::testing
