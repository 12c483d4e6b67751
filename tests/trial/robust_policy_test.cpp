#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "combined_study.hpp"
#include "core/instruction_set.hpp"
#include "every_method.hpp"
#include "imperfect_study.hpp"
#include "nightly.hpp"
#include "trial/lockstep_runner.hpp"
#include "trial/replay.hpp"

/// Whole trials of the robust policy (engine/control/README.md), and the stroke limit.
namespace steerstat::testing {
namespace {

std::vector<TrialParameters> robust_study(std::size_t trials) {
  std::vector<TrialParameters> study = combined_study(trials);
  for (TrialParameters& trial : study) trial.controller.policy = Policy::robust;
  return study;
}

class RobustTrial : public EveryMethod {};

TEST_P(RobustTrial, ConvergesWhateverTheCombinedStudyDraws) {
  for (const TrialParameters& trial : robust_study(GetParam() == IntegratorChoice::Method::lockstep ? 300 : 10)) {
    const TrialOutcome outcome = run(trial);
    EXPECT_EQ(outcome.status, Status::converged);
    EXPECT_LE(outcome.passive_error, 0.005);
    EXPECT_LE(outcome.active_error, 0.02);
    EXPECT_LE(outcome.peak_acceleration, 19.0);
  }
}

TEST_P(RobustTrial, ConvergesFromAQuickSpin) {
  std::vector<TrialParameters> study = robust_study(GetParam() == IntegratorChoice::Method::lockstep ? 100 : 4);
  for (TrialParameters& trial : study) {
    trial.start.q2_dot = std::copysign(1.0 + std::abs(trial.start.q2_dot), trial.start.q2_dot);
    trial.plant.f2 = 0.02 + 0.6 * trial.plant.f2;
    EXPECT_EQ(run(trial).status, Status::converged) << trial.start.q2_dot;
  }
}

TEST_P(RobustTrial, ReplaysToTheSameBits) {
  for (const TrialParameters& trial : robust_study(3)) {
    const Trajectory trajectory = replay(trial, integrator());
    EXPECT_EQ(trajectory.outcome, run(trial));
    EXPECT_EQ(trajectory.samples.back().t, trajectory.outcome.end_time);
  }
}

/// Trials of the robust policy, most of them far from what it can do: quick joints, heavy and light links, strong
/// friction, soft and stiff gains. Always the same ones.
std::vector<TrialParameters> wild_study(std::size_t trials, bool imperfect) {
  std::vector<TrialParameters> study = imperfect ? imperfect_study(trials) : combined_study(trials);
  std::mt19937_64 generator(23);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(generator() >> 11) * 0x1p-53);
  };
  const auto log_uniform = [&](double low, double high) { return low * std::pow(high / low, uniform(0.0, 1.0)); };
  for (TrialParameters& trial : study) {
    trial.controller.policy = Policy::robust;
    trial.controller.robust.max_acceleration = log_uniform(0.3, 40.0);
    trial.controller.alignment.kp = log_uniform(1.0, 30.0);
    trial.controller.alignment.kd = log_uniform(1.0, 15.0);
    trial.controller.horizon = 30.0;
    trial.plant.m1 = uniform(0.3, 3.0);
    trial.plant.m2 = uniform(0.3, 3.0);
    trial.plant.f1 = uniform(0.0, 0.5);
    trial.plant.f2 = uniform(0.0, 0.5);
    trial.start.q1_dot = uniform(-3.0, 3.0);
    trial.start.q2_dot = uniform(-8.0, 8.0);
  }
  return study;
}

TEST_P(RobustTrial, NoTrialAsksForMoreThanTheBoundOnTheAcceleration) {
  const std::size_t few = is_sanitized ? 10 : 40, many = is_sanitized ? 60 : is_nightly() ? 20'000 : 1500;
  for (const bool imperfect : {false, true}) {
    std::size_t cut = 0;
    for (const TrialParameters& trial :
         wild_study(GetParam() == IntegratorChoice::Method::lockstep ? many : few, imperfect)) {
      const TrialOutcome outcome = run(trial);
      EXPECT_LE(outcome.peak_acceleration, trial.controller.robust.max_acceleration) << imperfect;
      if (outcome.peak_acceleration > 0.999998 * trial.controller.robust.max_acceleration) ++cut;
    }
    EXPECT_GT(cut, 0u) << "some came to it";
  }
}

TEST_P(RobustTrial, StaysWithinAStrokeLimitThatTheNominalPlantCanKeep) {
  TrialParameters trial;
  trial.controller.policy = Policy::robust;
  trial.start.q1 = 0.0;
  trial.start.q2 = -0.6;
  const double free = run(trial).peak_stroke;
  trial.controller.max_stroke = 0.5 * free;
  const TrialOutcome outcome = run(trial);
  EXPECT_EQ(outcome.status, Status::converged);
  EXPECT_LE(outcome.peak_stroke, 0.5 * free);
}

INSTANTIATE_TEST_SUITE_P(Methods, RobustTrial, every_method(), method_name);

TEST(RobustPolicy, BothRunnersAgreeTrialByTrial) {
  const IntegratorChoice lockstep{IntegratorChoice::Method::lockstep, 1e-12};
  const IntegratorChoice cvode{IntegratorChoice::Method::cvode, 1e-12};
  for (const TrialParameters& trial : robust_study(6)) {
    const TrialOutcome a = make_runner(lockstep)->run(trial), b = make_runner(cvode)->run(trial);
    EXPECT_EQ(a.status, b.status);
    EXPECT_EQ(a.cycles, b.cycles);
    EXPECT_EQ(a.swings, b.swings);
    EXPECT_EQ(a.alignments, b.alignments);
    EXPECT_NEAR(a.end_time, b.end_time, 1e-5);
    EXPECT_NEAR(a.peak_stroke, b.peak_stroke, 1e-7);
  }
}

/// Hands out trials, and keeps their outcomes.
class Handout final : public TrialStream {
 public:
  explicit Handout(std::vector<TrialParameters> trials) : trials_(std::move(trials)), outcomes(trials_.size()) {}

  bool next(std::uint64_t& index, TrialParameters& parameters) override {
    if (taken_ == trials_.size()) return false;
    index = taken_;
    parameters = trials_[taken_++];
    return true;
  }
  void finished(std::uint64_t index, const TrialOutcome& outcome) override { outcomes[index] = outcome; }

 private:
  std::vector<TrialParameters> trials_;
  std::size_t taken_{0};

 public:
  std::vector<TrialOutcome> outcomes;
};

TEST(RobustPolicy, WhatALaneLearnedIsForgottenWithItsTrial) {
  const std::vector<TrialParameters> study = robust_study(150);  // more than there are lanes
  Handout together(study);
  LockstepRunner(1e-9, best_instruction_set()).run(together);
  for (std::size_t i = 0; i < study.size(); ++i) {
    EXPECT_EQ(together.outcomes[i], LockstepRunner(1e-9, best_instruction_set()).run(study[i])) << i;
  }
}

// --- the stroke limit, under either policy ---

class StrokeLimit : public EveryMethod {};

TEST_P(StrokeLimit, ATrialThatExceedsItHasDivergedWhenThePhaseEnds) {
  for (const Policy policy : {Policy::paper, Policy::robust}) {
    TrialParameters trial;
    trial.controller.policy = policy;
    trial.plant.m1 = trial.plant.m2 = 0.7;  // goes further than the controller believes
    const TrialOutcome free = run(trial);
    ASSERT_EQ(free.status, Status::converged);
    ASSERT_EQ(free.peak_stroke, 1.0);  // at its start

    trial.controller.max_stroke = 1.0;
    EXPECT_EQ(run(trial), free) << "exactly as far as it may";
    trial.controller.max_stroke = std::nextafter(1.0, 0.0);
    const TrialOutcome start = run(trial);
    EXPECT_EQ(start.status, Status::diverged);
    EXPECT_EQ(start.end_time, 0.0);
    EXPECT_EQ(start.alignments, 0u);

    trial.start.q1 = 0.0;
    trial.start.q1_dot = 0.5;
    trial.controller.max_stroke = 0.01;  // the align itself goes further
    const TrialOutcome outcome = run(trial);
    EXPECT_EQ(outcome.status, Status::diverged);
    EXPECT_EQ(outcome.alignments, 1u);
    EXPECT_EQ(outcome.cycles + outcome.swings, 0u);
    EXPECT_GT(outcome.peak_stroke, 0.01);
    EXPECT_EQ(replay(trial, integrator()).outcome, outcome);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, StrokeLimit, every_method(), method_name);

}  // namespace
}  // namespace steerstat::testing
