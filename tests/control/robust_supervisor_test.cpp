#include "robust_policy_fixture.hpp"

#include <cmath>
#include <random>

/// What engine/control/README.md says of the robust policy beside its rules: bounds, learning, course.
namespace steerstat::testing {
namespace {

// --- bounds ---

TEST(RobustPolicy, NoPhaseAsksForMoreThanTheBounds) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> angle(-4.0, 4.0), speed(-3.0, 3.0), place(-3.0, 3.0), share(0.0, 1.0);
  for (int i = 0; i < 20000; ++i) {
    Robot robot;
    robot.controller.robust.max_acceleration = 0.1 + 40.0 * share(random);
    robot.controller.max_stroke = 3.0 * share(random);
    robot.experience.gain = 0.4 + 1.6 * share(random);
    robot.experience.friction = 0.5 * share(random);
    const State<double> x{place(random), angle(random), speed(random), speed(random)};
    const double bound = robot.controller.robust.max_acceleration * (1.0 + 1e-12);
    const Phase phase = steer_robustly(x, robot.experience, robot.controller, robot.goal);
    ASSERT_NE(phase.kind, PhaseKind::align);
    if (phase.kind == PhaseKind::drift) {
      const bool up = phase.direction > 0.0;
      EXPECT_TRUE(up ? phase.q2_high > x.q2 : phase.q2_low < x.q2) << "a drift that no guard ends";
      EXPECT_GT(phase.direction * x.q2_dot, phase.speed_floor) << "a drift that no guard ends";
    } else {
      EXPECT_LE(cycle_peak * phase.amplitude / (phase.duration * phase.duration), bound);
      const double excursion = cycle_excursion * phase.amplitude;
      EXPECT_TRUE(excursion == 0.0 || std::abs(x.q1) + excursion <= robot.controller.max_stroke * (1.0 + 1e-12));
    }
    const Phase align = align_robustly(x, robot.controller, robot.goal);
    EXPECT_LE(7.0 * align.pace * align.pace * std::abs(x.q1) + 5.0 * align.pace * std::abs(x.q1_dot), 0.9 * bound);
    EXPECT_LE(align.pace, 1.0);
    EXPECT_LT(align.ceiling, robot.controller.robust.max_acceleration);
    EXPECT_GT(align.ceiling, 0.99999 * robot.controller.robust.max_acceleration);
  }
}

TEST(RobustPolicy, AnAlignIsNoSlowerThanItsBoundAsksAndEnds) {
  Robot robot;
  const Phase free = align_robustly({1.0, 0.0, 0.5, 0.0}, robot.controller, robot.goal);
  EXPECT_EQ(free.pace, 1.0);
  EXPECT_EQ(free.duration, 3.5);
  robot.controller.robust.max_acceleration = 3.0;
  const Phase slow = align_robustly({1.0, 0.0, 0.5, 0.0}, robot.controller, robot.goal);
  EXPECT_NEAR(7.0 * slow.pace * slow.pace + 2.5 * slow.pace, 0.9 * 3.0, 1e-12);
  EXPECT_NEAR(slow.duration, 3.5 / slow.pace, 1e-12);
}

TEST(RobustPolicy, APaceIsTooQuickWhereItAsksForNearlyTheBound) {
  Robot robot;
  robot.controller.robust.max_acceleration = 4.0;
  const auto too_fast = [&](double q1, double q1_dot, double pace) {
    return aligns_too_fast({q1, 0.0, q1_dot, 0.0}, pace, robot.controller, robot.goal);
  };
  const double limit = 0.95 * 4.0;
  EXPECT_TRUE(too_fast(-limit / 7.0 * (1.0 + 1e-12), 0.0, 1.0));
  EXPECT_FALSE(too_fast(limit / 7.0 * (1.0 - 1e-12), 0.0, 1.0));
  EXPECT_TRUE(too_fast(0.0, -limit / 2.5 * (1.0 + 1e-12), 0.5));
  EXPECT_FALSE(too_fast(0.0, limit / 2.5 * (1.0 - 1e-12), 0.5));
  EXPECT_TRUE(too_fast(0.5, -0.1, 1.0)) << "both count, whatever their signs";
  EXPECT_FALSE(too_fast(0.5, -0.1, 0.95));
}

TEST(RobustPolicy, AQuickJointTurnsNoMoreThanARadianInACycle) {
  const Robot robot;
  EXPECT_NEAR(robot.steer(0.4, 1.25).duration, 0.8, 1e-12 + 0.05 * 0.8);
  EXPECT_LE(robot.steer(0.4, 5.0).duration, 0.5 * 1.05);
  EXPECT_GE(robot.steer(0.4, 5.0).duration, 0.5);
}

// --- learning ---

TEST(Learning, FrictionIsTheSpeedLostInADriftPerRadian) {
  Robot robot;
  const auto friction_after = [&](double turned, double lost) {
    Experience known;
    embark(Phase{PhaseKind::drift}, {0.0, 1.0, 0.0, 0.3}, known);
    learn({0.0, 1.0 + turned, 0.0, 0.3 - lost}, robot.controller, robot.goal, known);
    return known.friction;
  };
  EXPECT_NEAR(friction_after(0.5, 0.05), 0.1, 1e-12);
  EXPECT_EQ(friction_after(0.0999, 0.05), 0.0);  // too short a drift
  EXPECT_EQ(friction_after(0.5, -0.05), 0.0);
  EXPECT_EQ(friction_after(0.2, 0.15), 0.5);
}

TEST(Learning, TheGainIsWhatACycleDidOverWhatItShouldHaveDone) {
  Robot robot;
  robot.experience.friction = 0.1;
  const State<double> start{0.0, pi - 0.8, 0.0, 0.0};
  const Phase cycle = steer_robustly(start, robot.experience, robot.controller, robot.goal);
  embark(cycle, start, robot.experience);
  const auto gain_after = [&](double gained, double turned) {
    Experience known = robot.experience;
    learn({0.0, start.q2 + turned, 0.0, gained}, robot.controller, robot.goal, known);
    EXPECT_EQ(known.leg, Experience::Leg::none);
    return known.gain;
  };
  const double turned = 0.6;
  for (const double gain : {0.5, 1.0, 1.5}) {
    double gained = 0.3;  // solved for, as the mean angle depends on it
    for (int i = 0; i < 200; ++i) {
      gained = gain * push_of(cycle, start.q2 + cycle.duration * gained / 8.0) - 0.1 * turned;
    }
    EXPECT_NEAR(gain_after(gained, turned), gain, 1e-9);
  }
  EXPECT_EQ(gain_after(3.0, turned), 2.0);
  EXPECT_EQ(gain_after(-0.3, turned), 0.4);
}

TEST(Learning, AnAlignBelongsToTheCycleBeforeIt) {
  const Robot robot;
  const State<double> x{0.5, pi - 0.8, 0.1, 0.1};
  Phase cycle;
  cycle.kind = PhaseKind::swing;
  Experience leg;
  embark(cycle, State<double>{}, leg);
  Experience after = leg;
  embark(Phase{PhaseKind::align}, x, after);
  EXPECT_EQ(after, leg);
  const Decision realigned = robot.after(PhaseKind::swing, x);
  ASSERT_FALSE(realigned.outcome.has_value());
  EXPECT_EQ(realigned.phase.kind, PhaseKind::align);
  EXPECT_EQ(realigned.phase.duration, 3.5);
}

// --- in the supervisor ---

TEST(RobustSupervisor, WhatEndsATrialIsThePapers) {
  const Robot robot;
  EXPECT_EQ(robot.after(PhaseKind::align, {0.0, pi / 4 + 0.002, 0.0, 0.002}).outcome, Status::converged);
  EXPECT_EQ(robot.after(PhaseKind::align, {0.0, 0.0, 0.0, 0.0}).outcome, Status::singular);
  EXPECT_EQ(robot.after(PhaseKind::align, {0.0, 1.0, 0.0, 0.0}, 300.0).outcome, Status::timeout);
  EXPECT_EQ(robot.after(PhaseKind::align, {1001.0, 1.0, 0.0, 0.0}).outcome, Status::diverged);
  EXPECT_EQ(robot.after(PhaseKind::align, {0.03, pi / 4, 0.0, 0.0}).phase.kind, PhaseKind::align);
}

TEST(RobustSupervisor, AnAlignCutAtItsCeilingGoesOnAtASlowerPaceWithoutEndingItsLeg) {
  const Robot robot;
  const State<double> x{-1.0, 1.0, 3.0, 0.3};  // 7 + 15 is more than 19
  Memory memory{PhaseKind::align};
  memory.experience.leg = Experience::Leg::cycle;
  double pace = 1.0;
  for (int i = 0; i < 15; ++i) {
    memory.pace = pace;
    const Decision cut =
        decide(1.0, {-1.0 / (pace * pace), 1.0, 3.0 / pace, 0.3}, memory, robot.controller, robot.goal);
    ASSERT_FALSE(cut.outcome.has_value());
    ASSERT_EQ(cut.phase.kind, PhaseKind::align);
    EXPECT_LT(cut.phase.pace, 0.98 * pace);
    EXPECT_EQ(cut.memory.pace, cut.phase.pace);
    EXPECT_EQ(cut.memory.experience, memory.experience);
    EXPECT_EQ(cut.memory.decisions, memory.decisions + 1) << "so that it cannot go on for ever";
    memory = cut.memory;
    pace = cut.phase.pace;
  }
  const Decision same = decide(1.0, x, {PhaseKind::align, 0, 0, 0, 0, 0.5}, robot.controller, robot.goal);
  EXPECT_NE(same.phase.kind, PhaseKind::align) << "at half the pace it asks for 9.25: it ended for another reason";
  memory.pace = 1.0;
  memory.decisions = most_decisions;
  EXPECT_EQ(decide(1.0, x, memory, robot.controller, robot.goal).outcome, Status::timeout);
  Robot paper;
  paper.controller.policy = Policy::paper;
  EXPECT_NE(decide(1.0, x, Memory{PhaseKind::align}, paper.controller, paper.goal).phase.kind, PhaseKind::align);
}

TEST(RobustSupervisor, CountsBrakesAsCyclesAndOtherPushesAsSwings) {
  const Robot robot;
  const Decision brake = robot.after(PhaseKind::align, {0.0, 0.3, 0.0, 0.25});
  EXPECT_EQ(brake.memory.cycles, 1u);
  EXPECT_EQ(brake.memory.swings, 0u);
  EXPECT_EQ(brake.memory.experience.leg, Experience::Leg::cycle);
  const Decision push = robot.after(PhaseKind::align, {0.0, -0.6, 0.0, 0.0});
  EXPECT_EQ(push.memory.cycles, 0u);
  EXPECT_EQ(push.memory.swings, 1u);
}

TEST(RobustSupervisor, ThePaperPolicyRemembersNothing) {
  Robot robot;
  robot.controller.policy = Policy::paper;
  for (const double q2 : {-0.6, 0.4, 2.0}) {
    EXPECT_EQ(robot.after(PhaseKind::align, {0.0, q2, 0.0, 0.1}).memory.experience, Experience{});
  }
}

}  // namespace
}  // namespace steerstat::testing
