#include "trial/replay.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "combined_study.hpp"
#include "core/errors.hpp"
#include "every_method.hpp"
#include "trial/course.hpp"

namespace steerstat::testing {
namespace {

class Replay : public EveryMethod {};

bool is_multiple_of(double t, double interval) {
  return t == std::nearbyint(t / interval) * interval;
}

TEST_P(Replay, EndsInTheBitsOfTheRunHoweverFinelyItIsSampled) {
  for (const TrialParameters& trial : combined_study(40)) {
    const TrialOutcome outcome = run(trial);
    for (const double interval : {0.013, 0.05, 1e3}) {
      EXPECT_TRUE(same_bits(replay(trial, integrator(), interval).outcome, outcome)) << interval;
    }
  }
}

TEST_P(Replay, EveryPhaseHasItsStartItsEndAndTheMultiplesBetween) {
  constexpr double interval = 0.05;
  for (const TrialParameters& trial : combined_study(10)) {
    const Trajectory trajectory = replay(trial, integrator(), interval);
    const auto& rows = trajectory.samples;
    ASSERT_GE(rows.size(), 2u);
    EXPECT_EQ(rows.front().t, 0.0);
    EXPECT_EQ(rows.front().state, trial.start);
    EXPECT_EQ(rows.back().t, trajectory.outcome.end_time);
    EXPECT_EQ(rows.back().state, trajectory.outcome.end_state);
    for (std::size_t i = 1; i < rows.size(); ++i) {
      if (rows[i].t == rows[i - 1].t) {
        EXPECT_EQ(rows[i].state, rows[i - 1].state) << "a boundary is one moment of two phases";
        continue;
      }
      EXPECT_GT(rows[i].t, rows[i - 1].t);
      EXPECT_LE(rows[i].t - rows[i - 1].t, interval * (1.0 + 1e-12));
      EXPECT_EQ(rows[i].phase, rows[i - 1].phase);
      const bool ends_phase = i + 1 == rows.size() || rows[i + 1].t == rows[i].t;
      if (!ends_phase) {
        EXPECT_TRUE(is_multiple_of(rows[i].t, interval)) << rows[i].t;
      }
    }
  }
}

TEST_P(Replay, ItsPhasesAreThoseTheOutcomeCounts) {
  for (const TrialParameters& trial : combined_study(10)) {
    const Trajectory trajectory = replay(trial, integrator());
    std::map<PhaseKind, std::uint32_t> started;
    for (std::size_t i = 0; i < trajectory.samples.size(); ++i) {
      if (i == 0 || trajectory.samples[i].t == trajectory.samples[i - 1].t) ++started[trajectory.samples[i].phase];
    }
    EXPECT_EQ(started[PhaseKind::align], trajectory.outcome.alignments);
    EXPECT_EQ(started[PhaseKind::contraction], trajectory.outcome.cycles);
    EXPECT_EQ(started[PhaseKind::swing], trajectory.outcome.swings);
  }
}

TEST_P(Replay, ASampleDoesNotDependOnTheOthers) {
  const TrialParameters trial = combined_study(1)[0];
  const Trajectory coarse = replay(trial, integrator(), 0.5);
  const Trajectory fine = replay(trial, integrator(), 0.25);
  std::size_t i = 0;
  for (const TrajectorySample& sample : coarse.samples) {
    while (i < fine.samples.size() && fine.samples[i].t < sample.t) ++i;
    ASSERT_LT(i, fine.samples.size());
    EXPECT_EQ(fine.samples[i].t, sample.t);
    EXPECT_EQ(fine.samples[i].state, sample.state);
  }
  EXPECT_GT(fine.samples.size(), 3 * coarse.samples.size() / 2);
}

TEST_P(Replay, CarriesTheLawsAccelerationAndTheForceOnTheFirstJoint) {
  TrialParameters trial;  // the paper's start, on a plant that the controller does not know
  trial.plant.m1 = 1.15;
  trial.plant.f1 = 0.03;
  const Trajectory trajectory = replay(trial, integrator(), 0.01);
  double cycle_start = 0.0;
  bool cycled = false;
  for (std::size_t i = 0; i < trajectory.samples.size(); ++i) {
    const TrajectorySample& row = trajectory.samples[i];
    const auto& [q1, q2, q1_dot, q2_dot] = row.state;
    if (i == 0 || row.t == trajectory.samples[i - 1].t) cycle_start = row.t;
    if (row.phase == PhaseKind::align) {
      EXPECT_NEAR(row.a, 7.0 * (0.0 - q1) - 5.0 * q1_dot, 1e-13);
    }
    if (row.phase == PhaseKind::drift) {
      EXPECT_EQ(row.a, 0.0);
    }
    if (row.phase == PhaseKind::contraction && row.t == cycle_start) {
      EXPECT_EQ(row.a, 0.0);
      cycled = true;
    }
    const double s = std::sin(q2);
    const double tau = (2.0 - 0.25 * s * s / 1.25) * row.a - 0.5 * std::cos(q2) * q2_dot * q2_dot;
    EXPECT_NEAR(row.tau, tau, 1e-13 * (1.0 + std::abs(tau)));
  }
  EXPECT_TRUE(cycled);
}

TEST_P(Replay, ATrialWithoutPhasesHasNoRows) {
  TrialParameters trial;
  trial.start = {0.0, std::numbers::pi / 4, 0.0, 0.0};
  const Trajectory trajectory = replay(trial, integrator());
  EXPECT_TRUE(trajectory.samples.empty());
  EXPECT_EQ(trajectory.outcome.status, Status::converged);
}

TEST_P(Replay, RefusesAnIntervalThatIsNotPositive) {
  for (const double interval : {0.0, -0.1, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(replay(TrialParameters{}, integrator(), interval), BadUsage);
  }
}

INSTANTIATE_TEST_SUITE_P(, Replay, every_method(), method_name);

}  // namespace
}  // namespace steerstat::testing
