#include "trial/sensor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "trial/supervision.hpp"

namespace steerstat {
namespace {

Sensor noisy(std::uint64_t seed) {
  Sensor sensor;
  sensor.bias = {1.0, -2.0, 3.0, -4.0};
  sensor.noise = {0.1, 0.2, 0.3, 0.4};
  sensor.noise_seed = seed;
  return sensor;
}

TEST(Sensor, IsExactUntilABiasOrANoiseSaysOtherwise) {
  Sensor sensor;
  sensor.noise_seed = 7;
  EXPECT_TRUE(sensor.is_exact());
  EXPECT_EQ(sensor.error(3), State<double>{});
  sensor.bias.q2_dot = 1e-300;
  EXPECT_FALSE(sensor.is_exact());
  EXPECT_EQ(sensor.error(3), sensor.bias);
  sensor = {};
  sensor.noise.q1 = 1e-300;
  EXPECT_FALSE(sensor.is_exact());
}

TEST(Sensor, ErrorsAreAPureFunctionOfSeedAndReading) {
  std::set<double> errors;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (std::uint64_t k = 0; k < 20; ++k) {
      EXPECT_EQ(noisy(seed).error(k), noisy(seed).error(k));
      errors.insert(noisy(seed).error(k).q1);
    }
  }
  EXPECT_EQ(errors.size(), 400U);
}

/// Means, standard deviations and correlations of the noise over readings of one trial, and over trials of one reading,
/// within four of their standard errors.
TEST(Sensor, NoiseIsIndependentNormalsAboutTheBias) {
  constexpr int draws = 20'000;
  for (const bool over_trials : {false, true}) {
    std::array<double, 4> sum{};
    std::array<std::array<double, 4>, 4> products{};
    int beyond = 0;
    for (std::uint64_t i = 0; i < draws; ++i) {
      const State<double> e = over_trials ? noisy(i).error(3) : noisy(99).error(i);
      const std::array<double, 4> z{(e.q1 - 1.0) / 0.1, (e.q2 + 2.0) / 0.2, (e.q1_dot - 3.0) / 0.3,
                                    (e.q2_dot + 4.0) / 0.4};
      for (std::size_t a = 0; a < 4; ++a) {
        sum[a] += z[a];
        beyond += std::abs(z[a]) > 1.959963984540054 ? 1 : 0;
        for (std::size_t b = 0; b < 4; ++b) products[a][b] += z[a] * z[b];
      }
    }
    const double n = draws;
    for (std::size_t a = 0; a < 4; ++a) {
      EXPECT_NEAR(sum[a] / n, 0.0, 4.0 / std::sqrt(n));
      EXPECT_NEAR(std::sqrt(products[a][a] / n), 1.0, 4.0 / std::sqrt(2.0 * n));
      for (std::size_t b = 0; b < a; ++b) EXPECT_NEAR(products[a][b] / n, 0.0, 4.0 / std::sqrt(n));
    }
    EXPECT_NEAR(beyond / (4.0 * n), 0.05, 4.0 * std::sqrt(0.05 * 0.95 / (4.0 * n)));
  }
}

Decision decided(Supervision& supervision, const TrialParameters& trial, double t, const State<double>& x) {
  Decision decision;
  decision.outcome = supervision.decide(trial, t, x, decision.phase);
  decision.memory = supervision.memory();
  return decision;
}

TEST(Supervision, ReadsAnewForEachDecisionAndHoldsTheErrorInThePhase) {
  TrialParameters trial;
  trial.sensor = noisy(5);
  trial.sensor.bias = {};
  Supervision supervision;
  for (std::uint64_t k = 0; k < 3; ++k) {
    const State<double> error = trial.sensor.error(k);
    const State<double> x{0.4, 0.5, 0.0, 0.0};
    const Memory before = supervision.memory();
    const Decision got = decided(supervision, trial, 1.0, x);
    const Decision expected = decide(1.0, reading(x, error), before, trial.controller, trial.goal);
    EXPECT_EQ(got.memory, expected.memory);
    EXPECT_EQ(got.outcome, expected.outcome);
    EXPECT_EQ(got.phase.kind, expected.phase.kind);
    if (got.phase.kind == PhaseKind::align) {
      EXPECT_EQ(got.phase.q1_offset, error.q1);
      EXPECT_EQ(got.phase.q1_dot_offset, error.q1_dot);
    }
  }
}

TEST(Supervision, ADriftsBoundsAreShiftedSoThatTheReadingMeetsThem) {
  TrialParameters trial;
  trial.sensor.bias = {0.0, 0.02, 0.0, 0.003};
  trial.start = {0.0, -1.0, 0.0, 0.3};
  Supervision supervision;
  const Decision got = decided(supervision, trial, 0.0, trial.start);
  const Decision expected =
      decide(0.0, reading(trial.start, trial.sensor.bias), Memory{}, trial.controller, trial.goal);
  ASSERT_EQ(got.phase.kind, PhaseKind::drift);
  EXPECT_DOUBLE_EQ(got.phase.q2_high + 0.02, expected.phase.q2_high);
  EXPECT_EQ(got.phase.q2_low, -Phase::unbounded);
  EXPECT_DOUBLE_EQ(got.phase.speed_floor + got.phase.direction * 0.003, expected.phase.speed_floor);
}

TEST(Supervision, WithoutErrorsItIsTheSupervisorToTheBit) {
  TrialParameters trial;
  trial.start = {0.0, -1.0, 0.0, 0.3};
  Supervision supervision;
  const Decision got = decided(supervision, trial, 0.0, trial.start);
  const Decision expected = decide(0.0, trial.start, Memory{}, trial.controller, trial.goal);
  EXPECT_EQ(got.phase, expected.phase);
  EXPECT_EQ(got.memory, expected.memory);
}

}  // namespace
}  // namespace steerstat
