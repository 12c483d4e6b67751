#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "combined_study.hpp"
#include "core/elementary.hpp"
#include "every_method.hpp"
#include "imperfect_study.hpp"
#include "integrate/cvode_integrator.hpp"
#include "integrate/lockstep_integrator.hpp"
#include "trial/course.hpp"
#include "trial/replay.hpp"

/// The effort and the peaks that a trial reports.
namespace steerstat::testing {
namespace {

/// Measures a trial's phases on their dense output: samples, Simpson's rule, and the parabolas through the highest.
class BruteForce final : public StepObserver {
 public:
  explicit BruteForce(const TrialParameters& parameters) : loop_(closed_loop_of(parameters)) {
    exertion.peak_stroke = std::abs(parameters.start.q1 - parameters.goal.q1);
  }

  void start(const Phase& phase, double t) {
    phase_ = phase;
    start_ = t;
  }

  void step(double from, double to, const DenseOutput& output) override {
    constexpr std::size_t intervals = 256;
    std::array<double, intervals + 1> a{}, tau{}, stroke{};
    double sum = 0.0;
    for (std::size_t i = 0; i <= intervals; ++i) {
      const double t = from + (to - from) * static_cast<double>(i) / intervals;
      const State<double> x = output.at(t);
      const auto [s, c] = sincos(x.q2);
      const double asked = commanded_acceleration(loop_, phase_, t - start_, x);
      const double force = driving_force(loop_, asked, x, s, c);
      a[i] = std::abs(asked);
      tau[i] = std::abs(force);
      stroke[i] = std::abs(x.q1 - loop_.q1_goal);
      sum += force * force * (i == 0 || i == intervals ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0));
    }
    exertion.effort += sum * (to - from) / (3.0 * intervals);
    raise(exertion.peak_acceleration, a);
    raise(exertion.peak_force, tau);
    exertion.peak_force = std::min(exertion.peak_force, loop_.actuator.max_force);  // no parabola fits its corner there
    raise(exertion.peak_stroke, stroke);
  }

  Exertion exertion;

 private:
  template <std::size_t n>
  static void raise(double& peak, const std::array<double, n>& y) {
    for (std::size_t i = 0; i < n; ++i) {
      peak = std::max(peak, y[i]);
      if (i == 0 || i + 1 == n || y[i] < y[i - 1] || y[i] < y[i + 1]) continue;
      const double bend = y[i - 1] - 2.0 * y[i] + y[i + 1];
      const double slope = 0.5 * (y[i + 1] - y[i - 1]);
      if (bend < 0.0) peak = std::max(peak, y[i] - 0.5 * slope * slope / bend);
    }
  }

  ClosedLoop<double> loop_;
  Phase phase_{};
  double start_{0.0};
};

template <class Integrator>
Exertion brute_force(const TrialParameters& trial, Integrator integrator) {
  BruteForce measured(trial);
  const ClosedLoop<double> loop = closed_loop_of(trial);
  (void)run_course(trial, measured.exertion, [&](const Phase& phase, double t, const State<double>& x, double t_end) {
    measured.start(phase, t);
    return integrator.advance(loop, phase, t, x, t_end, &measured);
  });
  return measured.exertion;
}

class TrialExertion : public EveryMethod {
 protected:
  [[nodiscard]] static bool is_lockstep() { return GetParam() == IntegratorChoice::Method::lockstep; }

  static void expect_as_sampled(const TrialParameters& trial) {
    const Exertion expected =
        is_lockstep() ? brute_force(trial, LockstepIntegrator(1e-9, best_instruction_set(), 0, loop_kind_of(trial)))
                      : brute_force(trial, CvodeIntegrator(1e-9));
    const TrialOutcome outcome = run(trial);
    constexpr double precision = 1e-6;
    EXPECT_NEAR(outcome.effort, expected.effort, precision * expected.effort);
    EXPECT_NEAR(outcome.peak_acceleration, expected.peak_acceleration, precision * expected.peak_acceleration);
    EXPECT_NEAR(outcome.peak_force, expected.peak_force, precision * expected.peak_force);
    EXPECT_NEAR(outcome.peak_stroke, expected.peak_stroke, precision * expected.peak_stroke);
  }
};

TEST_P(TrialExertion, IsThatOfTheTrajectorySampledFinely) {
  for (const TrialParameters& trial : combined_study(is_lockstep() ? 200 : 10)) expect_as_sampled(trial);
}

/// The force is the one applied: of the actuator's gain, and held at its limit.
TEST_P(TrialExertion, WithImperfectionsIsThatOfTheTrajectorySampledFinely) {
  for (const TrialParameters& trial : imperfect_study(is_lockstep() ? 40 : 4)) expect_as_sampled(trial);
}

TEST_P(TrialExertion, IsThatOfATighterReferenceOnTrialsOfTheSameCourse) {
  constexpr std::size_t trials = 100;
  const auto study = combined_study(trials);
  const auto reference = make_runner({IntegratorChoice::Method::cvode, 1e-12});
  std::vector<double> differences;
  for (const TrialParameters& trial : study) {
    const TrialOutcome ours = run(trial);
    const TrialOutcome other = reference->run(trial);
    if (ours.cycles != other.cycles || ours.swings != other.swings || ours.alignments != other.alignments) continue;
    const auto relative = [](double x, double y) { return std::abs(x - y) / std::abs(y); };
    differences.push_back(
        std::max({relative(ours.effort, other.effort), relative(ours.peak_acceleration, other.peak_acceleration),
                  relative(ours.peak_force, other.peak_force), relative(ours.peak_stroke, other.peak_stroke),
                  std::isnan(other.position_contraction.mean)
                      ? 0.0
                      : relative(ours.position_contraction.mean, other.position_contraction.mean)}));
  }
  ASSERT_GE(differences.size(), trials - 1);
  std::ranges::sort(differences);
  EXPECT_LT(differences[differences.size() / 2], 1e-7);
  // Long trials amplify rounding, their efforts with their settling times.
  EXPECT_LT(differences[differences.size() * 9 / 10], 1e-6);
}

TEST_P(TrialExertion, OfATrialThatEndsAtOnceIsItsStrokeAlone) {
  TrialParameters trial;
  trial.start = {0.015, std::numbers::pi / 4, 0.0, 0.0};
  trial.controller.alignment.tolerance = 0.02;
  const TrialOutcome outcome = run(trial);
  ASSERT_EQ(outcome.end_time, 0.0);
  EXPECT_EQ(outcome.effort, 0.0);
  EXPECT_EQ(outcome.peak_acceleration, 0.0);
  EXPECT_EQ(outcome.peak_force, 0.0);
  EXPECT_EQ(outcome.peak_stroke, 0.015);
}

TEST_P(TrialExertion, OfThePapersRunIsThatOfItsAlignAndItsLargestCycle) {
  TrialParameters trial;  // from (1, -pi/4) at rest
  trial.controller.realignment = Realignment::never;
  trial.controller.alignment.tolerance = 3.33e-4;
  const TrialOutcome outcome = run(trial);
  EXPECT_NEAR(outcome.peak_acceleration, 7.0, 1e-14) << "kp times the distance, at the start";
  // (m1 + m2 - (m2 d2 sin q2)^2 / (I2 + m2 d2^2)) a there
  EXPECT_NEAR(outcome.peak_force, (2.0 - 0.125 / 1.25) * 7.0, 1e-12);
  EXPECT_GE(outcome.peak_stroke, 1.0);
  EXPECT_GT(outcome.effort, 0.0);
}

TEST_P(TrialExertion, IsLeftOutWhereNobodyAsksAndChangesNothingElse) {
  IntegratorChoice without = integrator();
  without.metrics = false;
  const auto runner = make_runner(without);
  for (const TrialParameters& trial : combined_study(20)) {
    const TrialOutcome measured = run(trial);
    TrialOutcome outcome = runner->run(trial);
    EXPECT_TRUE(same_bits(outcome, replay(trial, without, 1.0).outcome));
    EXPECT_TRUE(std::isnan(outcome.effort) && std::isnan(outcome.peak_acceleration));
    EXPECT_TRUE(std::isnan(outcome.peak_force) && std::isnan(outcome.peak_stroke));
    EXPECT_FALSE(std::isnan(measured.effort));
    outcome.effort = measured.effort;
    outcome.peak_acceleration = measured.peak_acceleration;
    outcome.peak_force = measured.peak_force;
    outcome.peak_stroke = measured.peak_stroke;
    EXPECT_TRUE(same_bits(outcome, measured));
  }
}

INSTANTIATE_TEST_SUITE_P(, TrialExertion, every_method(), method_name);

}  // namespace
}  // namespace steerstat::testing
