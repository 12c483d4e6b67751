#include "supervision_fixture.hpp"

#include <algorithm>
#include <cmath>

#include "control/cycle.hpp"

/// Rules 4-7 of CONTROLLER.md section 5, at their boundaries, on both sides.
namespace steerstat::testing {
namespace {

// --- rule 4, contraction ---

TEST(Supervisor, ContractsFromTheEntryPointToTheGoal) {
  const Supervision s;
  const double w = s.goal.width;
  EXPECT_EQ(s.steer(0.5 * w - 1e-6, 0.1).kind, PhaseKind::contraction);
  EXPECT_EQ(s.steer(below(0.5 * w - 1e-6), 0.1).kind, PhaseKind::drift);
  EXPECT_EQ(s.steer(below(w), 0.1).kind, PhaseKind::contraction);
  EXPECT_EQ(s.steer(w, 0.1).kind, PhaseKind::drift);
}

TEST(Supervisor, ContractsOnlyTowardsTheGoal) {
  Supervision s;
  s.controller.contraction.max_period = 1e12;
  EXPECT_EQ(s.steer(0.6, 1e-10).kind, PhaseKind::contraction);
  EXPECT_EQ(s.steer(0.6, 0.0).kind, PhaseKind::swing);
  EXPECT_EQ(s.steer(0.6, -1e-10).kind, PhaseKind::swing);
}

TEST(Supervisor, ACycleLongerThanTheLongestIsASwingInstead) {
  Supervision s;
  const Phase phase = s.steer(0.6, 0.05);
  ASSERT_EQ(phase.kind, PhaseKind::contraction);
  s.controller.contraction.max_period = phase.duration;
  EXPECT_EQ(s.steer(0.6, 0.05).kind, PhaseKind::contraction);
  s.controller.contraction.max_period = below(phase.duration);
  EXPECT_EQ(s.steer(0.6, 0.05).kind, PhaseKind::swing) << "a slow joint inside the set must not drift past the goal";
}

TEST(Supervisor, TheCycleHasThePeriodAndAmplitudeOf16And17) {
  Supervision s;
  s.controller.contraction = {0.3, 0.7, 30.0};
  const double q2 = 0.5;
  const double omega = 0.08;
  const Phase phase = s.steer(q2, omega);
  const double period = 0.7 * (pi / 4 - q2) / omega;
  EXPECT_NEAR(phase.duration, period, 1e-14 * period);
  const double amplitude = std::sqrt(period * 0.3 * omega / (0.16 * beta * std::sin(2.0 * q2)));
  EXPECT_NEAR(phase.amplitude, amplitude, 1e-14 * amplitude);
}

// --- rule 5, drift towards the goal ---

TEST(Supervisor, DriftsTowardsTheGoalFasterThanRestAlone) {
  const Supervision s;
  EXPECT_EQ(s.steer(1.2, above(1e-3)).kind, PhaseKind::drift);
  EXPECT_EQ(s.steer(1.2, 1e-3).kind, PhaseKind::swing);
}

TEST(Supervisor, TheDriftEndsAtTheEntryPointOrAtRest) {
  const Supervision s;
  const double entry = pi / 8;
  for (const double q2 : {-2.0, -0.3, 0.0, 0.1}) {
    const Phase phase = s.steer(q2, 0.1);
    ASSERT_EQ(phase.kind, PhaseKind::drift);
    EXPECT_NEAR(phase.q2_high, entry, 4e-15) << q2;
    EXPECT_EQ(phase.q2_low, -infinity);
    EXPECT_EQ(phase.direction, 1.0);
    EXPECT_EQ(phase.speed_floor, 0.99e-3);
    EXPECT_EQ(phase.duration, infinity);
    EXPECT_LT(phase.active_tolerance, 0.0);
  }
  EXPECT_NEAR(s.steer(1.0, 0.1).q2_high, entry + 2.0 * pi, 4e-15);  // past the goal: once round
  EXPECT_NEAR(s.steer(pi / 8 - 1.1e-6, 0.1).q2_high, entry, 4e-15);
  EXPECT_NEAR(s.steer(1.0 - 6.0 * pi, 0.1).q2_high, entry - 4.0 * pi, 1e-13);
}

TEST(Supervisor, ASlowDriftIsSpedUpWhereASwingCan) {
  Supervision s;
  s.controller.drift.min_speed = 0.05;
  const double edge = -0.5 * std::asin(0.4);  // s2 = -0.4
  EXPECT_EQ(s.steer(edge - 1e-9, below(0.05)).kind, PhaseKind::swing);
  EXPECT_EQ(s.steer(edge + 1e-9, below(0.05)).kind, PhaseKind::drift);
  EXPECT_EQ(s.steer(edge - 1e-9, 0.05).kind, PhaseKind::drift);
}

// --- rule 6, drift away from the goal ---

TEST(Supervisor, DriftsAwayFromTheGoalFasterThanRestAlone) {
  const Supervision s;
  EXPECT_EQ(s.steer(0.6, -above(1e-3)).kind, PhaseKind::drift);
  EXPECT_EQ(s.steer(0.6, -1e-3).kind, PhaseKind::swing);
}

TEST(Supervisor, DriftsAwayOnlyWhereASwingHasNoAuthority) {
  const Supervision s;
  const double edge = -0.5 * std::asin(0.4);  // s2 = -0.4
  EXPECT_EQ(s.steer(edge + 1e-9, -0.1).kind, PhaseKind::drift);
  EXPECT_EQ(s.steer(edge - 1e-9, -0.1).kind, PhaseKind::swing);
}

TEST(Supervisor, TheDriftAwayEndsWhereASwingHasAuthorityOrAtRest) {
  Supervision s;
  for (const double authority : {0.1, 0.4, 0.89}) {
    s.controller.swing.min_authority = authority;
    for (const double turns : {0.0, 0.5, 1.0, -3.5}) {
      for (const double offset : {-0.02, 0.0, 0.3, pi / 2, pi / 2 + 0.02}) {
        const double q2 = offset + turns * 2.0 * pi;
        const Phase phase = s.steer(q2, -0.1);
        ASSERT_EQ(phase.kind, PhaseKind::drift);
        EXPECT_NEAR(std::sin(2.0 * phase.q2_low), -(authority + 0.1), 1e-13);
        EXPECT_NEAR(std::sin(2.0 * phase.q2_high), -(authority + 0.1), 1e-13);
        EXPECT_LT(phase.q2_low, q2);
        EXPECT_GT(phase.q2_high, q2);
        EXPECT_LT(phase.q2_high - phase.q2_low, pi);  // the nearest such angles on both sides
        EXPECT_EQ(phase.direction, -1.0);
        EXPECT_EQ(phase.speed_floor, 0.99e-3);
      }
    }
  }
}

// --- rule 7, swing ---

double swing_amplitude(double change, double s2) {
  return std::sqrt(2.0 * change / (0.16 * beta * s2));
}

Supervision without_amplitude_bound() {
  Supervision s;
  s.controller.swing.max_amplitude = 1e9;
  return s;
}

TEST(Supervisor, ASwingBringsTheSpeedToTheWantedOneWhereItPushesTowardsTheGoal) {
  const Supervision s = without_amplitude_bound();
  for (const double omega : {0.0, 5e-4, -5e-4, -0.1}) {
    const Phase phase = s.steer(-0.6, omega);
    ASSERT_EQ(phase.kind, PhaseKind::swing);
    EXPECT_EQ(phase.duration, 2.0);
    const double amplitude = swing_amplitude(0.2 - omega, std::sin(1.2));
    EXPECT_NEAR(phase.amplitude, amplitude, 1e-13 * amplitude) << omega;
  }
}

TEST(Supervisor, ASwingBringsTheSpeedToTheOppositeOneWhereItPushesAway) {
  const Supervision s = without_amplitude_bound();
  for (const double omega : {0.0, 5e-4, -5e-4}) {
    const double amplitude = swing_amplitude(0.2 + omega, std::sin(1.2));
    EXPECT_NEAR(s.steer(0.6, omega).amplitude, amplitude, 1e-13 * amplitude) << omega;
  }
}

TEST(Supervisor, ASwingOfAJointFasterThanWantedUsesTheWantedSpeed) {
  Supervision s = without_amplitude_bound();
  s.controller.drift.min_speed = 1.0;  // so that a fast joint does not drift
  EXPECT_EQ(s.steer(-0.6, 0.2).amplitude, 0.0);
  EXPECT_LT(s.steer(-0.6, below(0.2)).amplitude, 1e-4);
  const double amplitude = swing_amplitude(0.2, std::sin(1.2));
  EXPECT_NEAR(s.steer(-0.6, above(0.2)).amplitude, amplitude, 1e-13 * amplitude);
}

TEST(Supervisor, TheSwingsAmplitudeIsBoundedByTheLargestAndByTheLeastSine) {
  Supervision s;
  EXPECT_EQ(s.steer(1e-5, 5e-4).amplitude, 200.0);
  s.controller.swing.max_amplitude = 1e9;
  const double at_least_sine = swing_amplitude(0.2 + 5e-4, 1e-6);
  EXPECT_NEAR(s.steer(0.49e-6, 5e-4).amplitude, at_least_sine, 1e-13 * at_least_sine);
  EXPECT_LT(s.steer(0.51e-6, 5e-4).amplitude, at_least_sine);
}

}  // namespace
}  // namespace steerstat::testing
