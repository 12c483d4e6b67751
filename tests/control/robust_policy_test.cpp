#include "robust_policy_fixture.hpp"

/// The rules of engine/control/README.md, at their boundaries, on both sides.
namespace steerstat::testing {
namespace {

// --- braking and approaching ---

TEST(RobustPolicy, AQuickApproachIsBrakedToTheRatioAfterTheAlignThatFollows) {
  const Robot robot;
  const double y = 0.3, omega = 0.25, e = pi / 4 - y;
  const Phase phase = robot.steer(y, omega);
  ASSERT_EQ(phase.kind, PhaseKind::contraction);
  EXPECT_EQ(phase.duration, 1.8);
  const double after = 0.4 * (e - 0.9 * omega) / (1.0 + 0.4 * 2.1);
  EXPECT_NEAR(push_of(phase, y + 1.8 * (3.0 * omega + after) / 8.0), omega - after, 1e-12);
}

TEST(RobustPolicy, TheBrakeWaitsForTheEntryAndForTheRatio) {
  const Robot robot;
  const double entry = 0.3 * pi / 4;
  EXPECT_EQ(robot.steer(entry - 0.9e-6, 0.4).kind, PhaseKind::contraction);
  EXPECT_NE(robot.steer(entry - 1.1e-6, 0.4).kind, PhaseKind::contraction);
  const double ratio = 0.9 * 0.4 * (pi / 4 - 0.5);
  EXPECT_EQ(robot.steer(0.5, ratio * (1.0 + 1e-12)).kind, PhaseKind::contraction);
  EXPECT_EQ(robot.steer(0.5, ratio * (1.0 - 1e-12)).kind, PhaseKind::drift);
}

TEST(RobustPolicy, ASlowApproachDriftsUntilTheRatioIsReached) {
  Robot robot;
  robot.experience.friction = 0.1;
  const double y = 0.4, omega = 0.12, e = pi / 4 - y;
  const Phase phase = robot.steer(y, omega);
  ASSERT_EQ(phase.kind, PhaseKind::drift);
  const double target = (omega - 0.1 * e) / (0.4 - 0.1);
  EXPECT_NEAR(phase.q2_high, pi / 4 - target, 1e-12);
  EXPECT_EQ(phase.q2_low, -Phase::unbounded);
  EXPECT_EQ(phase.direction, 1.0);
  EXPECT_NEAR((omega - 0.1 * (e - target)) / target, 0.4, 1e-12);  // the ratio there, with that friction
  EXPECT_NEAR(phase.speed_floor, e / 20.0, 1e-12);
}

TEST(RobustPolicy, AnApproachThatFrictionStopsIsPushed) {
  Robot robot;
  const double e = pi / 4 - 0.4;
  robot.experience.friction = 0.2;
  EXPECT_EQ(robot.steer(0.4, 0.2 * e * 1.001).kind, PhaseKind::drift);
  EXPECT_EQ(robot.steer(0.4, 0.2 * e * 0.999).kind, PhaseKind::swing);
}

TEST(RobustPolicy, ASmallOvershootCreepsBack) {
  const Robot robot;
  const Phase push = robot.steer(pi / 4 + 0.02, 0.01);
  ASSERT_EQ(push.kind, PhaseKind::swing);
  EXPECT_NEAR(push_of(push, pi / 4 + 0.02), 0.003 + 0.01, 1e-12);
  const Phase drift = robot.steer(pi / 4 + 0.02, -0.003);
  ASSERT_EQ(drift.kind, PhaseKind::drift);
  EXPECT_NEAR(drift.q2_low, pi / 4 + 0.9 * 0.005 - 0.003, 1e-12);
  EXPECT_EQ(drift.direction, -1.0);
}

// --- travelling ---

TEST(RobustPolicy, AJointQuickEnoughCoastsToWhereTheNextPushWaits) {
  const Robot robot;
  const Phase home = robot.steer(-0.4, 0.25);
  ASSERT_EQ(home.kind, PhaseKind::drift);
  EXPECT_NEAR(home.q2_high, 0.3 * pi / 4, 1e-12);
  EXPECT_NEAR(home.speed_floor, 0.125, 1e-12);
  const Phase away = robot.steer(pi - 0.4, 0.25);
  ASSERT_EQ(away.kind, PhaseKind::drift);
  EXPECT_NEAR(away.q2_high, 1.5 * pi + delta, 1e-9);
  const Phase back = robot.steer(1.2, -0.25);
  ASSERT_EQ(back.kind, PhaseKind::drift);
  EXPECT_NEAR(back.q2_low, -0.6, 1e-12);
}

TEST(RobustPolicy, AJointTooSlowToTravelIsPushedToTheSpeedThatArrives) {
  Robot robot;
  EXPECT_EQ(robot.steer(pi - 0.8, 0.7 * 0.25 * 1.001).kind, PhaseKind::drift);
  EXPECT_EQ(robot.steer(pi - 0.8, 0.7 * 0.25 * 0.999).kind, PhaseKind::swing);
  robot.experience.friction = 0.05;
  const double wanted = 0.25 + 0.05 * (0.8 + 0.5 * pi + delta);
  const Phase push = robot.steer(pi - 0.8, 0.0);
  ASSERT_EQ(push.kind, PhaseKind::swing);
  EXPECT_NEAR(push_of(push, pi - 0.8 + 1.8 * wanted / 8.0), wanted, 1e-12);
}

TEST(RobustPolicy, WhatWasLearnedOfTheGainScalesThePush) {
  Robot robot;
  const Phase nominal = robot.steer(pi - 0.8, 0.0);
  robot.experience.gain = 0.64;
  EXPECT_NEAR(robot.steer(pi - 0.8, 0.0).amplitude, nominal.amplitude / 0.8, 1e-12 * nominal.amplitude);
}

TEST(RobustPolicy, CoastsAgainstThePushOnlyWhereFrictionLetsItArrive) {
  Robot robot;
  robot.experience.friction = 0.1;
  const double distance = 0.5 * pi + delta - 0.5;
  const Phase onward = robot.steer(pi + 0.5, 0.03 + 0.1 * distance + 1e-9);
  ASSERT_EQ(onward.kind, PhaseKind::drift);
  EXPECT_NEAR(onward.q2_high, 1.5 * pi + delta, 1e-9);
  const Phase turning = robot.steer(pi + 0.5, 0.03 + 0.1 * distance - 1e-9);
  ASSERT_EQ(turning.kind, PhaseKind::drift);
  EXPECT_NEAR(turning.q2_high, pi + 0.6, 1e-9);
}

TEST(RobustPolicy, TurnsBackFurtherOnWhereOneCycleCannotReverseIt) {
  Robot robot;
  robot.experience.friction = 0.2;
  EXPECT_EQ(robot.steer(pi + 0.6, 0.15).kind, PhaseKind::drift);
  EXPECT_NEAR(robot.steer(pi + 0.6, 0.15).q2_high, 1.25 * pi, 1e-9);
  EXPECT_EQ(robot.steer(1.25 * pi, 0.15).kind, PhaseKind::swing);
  robot.controller.robust.max_acceleration = 40.0;
  EXPECT_EQ(robot.steer(pi + 0.6, 0.15).kind, PhaseKind::swing);
}

TEST(RobustPolicy, LeavesADeadZoneAlongItsMotion) {
  const Robot robot;
  const Phase forth = robot.steer(1.5 * pi - 0.05, 0.02);
  ASSERT_EQ(forth.kind, PhaseKind::drift);
  EXPECT_GT(forth.q2_high, 1.5 * pi - 0.05);
  EXPECT_LE(forth.q2_high, 1.5 * pi - 0.05 + 0.2 + 1e-12);
  const Phase rest = robot.steer(pi / 2, 0.0);  // no motion, and |sin 2 q2| as small as it gets
  EXPECT_EQ(rest.kind, PhaseKind::swing);
}

TEST(RobustPolicy, SeesEveryQuadrantAlike) {
  // A goal in another quadrant is pi/4 turned, or mirrored: the rules see the same y.
  Robot first, second;
  second.goal = goal_at(0.0, 0.75 * pi);  // quadrant II: y = pi - q2
  for (const double y : {-1.2, -0.3, 0.3, 0.7, 0.9, 1.5, 2.5, 4.0}) {
    for (const double omega : {-0.4, -0.05, 0.02, 0.3}) {
      const Phase a = first.steer(y, omega), b = second.steer(pi - y, -omega);
      ASSERT_EQ(a.kind, b.kind) << y << ' ' << omega;
      EXPECT_NEAR(a.amplitude, b.amplitude, 1e-9 * a.amplitude);
      if (a.kind == PhaseKind::drift) {
        EXPECT_EQ(a.direction, -b.direction);
        EXPECT_NEAR(a.direction > 0.0 ? a.q2_high : a.q2_low, pi - (b.direction > 0.0 ? b.q2_high : b.q2_low), 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace steerstat::testing
