#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include "combined_study.hpp"
#include "every_method.hpp"
#include "imperfect_study.hpp"
#include "nightly.hpp"
#include "trial/lockstep_runner.hpp"
#include "trial/replay.hpp"

/// Trials with imperfections (engine/robot/README.md), and those without.
namespace steerstat::testing {
namespace {

/// Trials to compare with the reference, which is slow; slower still beside sanitizers.
std::size_t compared_trials() {
  return is_sanitized ? 6 : is_nightly() ? 1'500 : 150;
}

/// Serves trials in order, and keeps the outcomes.
class OrderedTrials final : public TrialStream {
 public:
  explicit OrderedTrials(const std::vector<TrialParameters>& trials) : outcomes(trials.size()), trials_(trials) {}

  bool next(std::uint64_t& index, TrialParameters& parameters) override {
    if (served_ == trials_.size()) return false;
    index = served_++;
    parameters = trials_[index];
    return true;
  }
  void finished(std::uint64_t index, const TrialOutcome& outcome) override { outcomes[index] = outcome; }

  std::vector<TrialOutcome> outcomes;

 private:
  const std::vector<TrialParameters>& trials_;
  std::size_t served_{0};
};

std::vector<TrialOutcome> run_all(const std::vector<TrialParameters>& trials, const IntegratorChoice& integrator,
                                  InstructionSet set = best_instruction_set()) {
  OrderedTrials stream(trials);
  make_runner(integrator, set)->run(stream);
  return stream.outcomes;
}

constexpr IntegratorChoice usual_lockstep{IntegratorChoice::Method::lockstep, 1e-9};

std::vector<InstructionSet> supported_sets() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2, InstructionSet::portable}) {
    if (supports(set)) sets.push_back(set);
  }
  return sets;
}

void expect_same_bits(const std::vector<TrialOutcome>& a, const std::vector<TrialOutcome>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(same_bits(a[i], b[i])) << "trial " << i;
}

/// To the bit, whatever the engine for trials with imperfections does.
TEST(IdealTrials, RunOnTheEngineThatKnowsNoImperfections) {
  const std::vector<TrialParameters> trials = combined_study(100);
  for (const InstructionSet set : supported_sets()) {
    LockstepRunner plain(usual_lockstep.tolerance, set);
    OrderedTrials stream(trials);
    plain.run(stream);
    expect_same_bits(run_all(trials, usual_lockstep, set), stream.outcomes);
  }
}

TEST(IdealTrials, AreNotTouchedBySmoothingVelocitiesAloneNorByTheSeedOfNoNoise) {
  std::vector<TrialParameters> trials = combined_study(40);
  const auto expected = run_all(trials, usual_lockstep);
  for (TrialParameters& trial : trials) {
    trial.disturbance.coulomb_speed1 = 0.5;
    trial.disturbance.coulomb_speed2 = 0.25;
    trial.sensor.noise_seed = 12345;
  }
  expect_same_bits(run_all(trials, usual_lockstep), expected);
}

TEST(ImperfectTrials, OutcomesAreTheSameBitsOnEveryInstructionSet) {
  const std::vector<TrialParameters> trials = imperfect_study(60);
  const auto expected = run_all(trials, usual_lockstep, InstructionSet::portable);
  for (const InstructionSet set : supported_sets()) expect_same_bits(run_all(trials, usual_lockstep, set), expected);
}

TEST(ImperfectTrials, AnOutcomeIsTheSameBitsAloneAndMixedWithOthersOfEitherKind) {
  const std::vector<TrialParameters> imperfect = imperfect_study(60);
  const std::vector<TrialParameters> ideal = combined_study(60);
  const auto of_imperfect = run_all(imperfect, usual_lockstep);
  const auto of_ideal = run_all(ideal, usual_lockstep);
  std::vector<TrialParameters> mixed;
  std::vector<TrialOutcome> expected;
  for (std::size_t i = 0; i < imperfect.size(); ++i) {
    for (const bool first : {i % 3 != 0, i % 3 == 0}) {
      mixed.push_back(first ? imperfect[i] : ideal[i]);
      expected.push_back(first ? of_imperfect[i] : of_ideal[i]);
    }
  }
  expect_same_bits(run_all(mixed, usual_lockstep), expected);
  const auto runner = make_runner(usual_lockstep);
  for (std::size_t i = 0; i < imperfect.size(); i += 11) {
    EXPECT_TRUE(same_bits(runner->run(imperfect[i]), of_imperfect[i])) << "alone: trial " << i;
  }
  // A lane without Coulomb friction among lanes that have it.
  std::vector<TrialParameters> some_rub = imperfect;
  for (std::size_t i = 0; i < some_rub.size(); i += 2) some_rub[i].disturbance.coulomb1 = 0.0;
  for (std::size_t i = 0; i < some_rub.size(); i += 4) some_rub[i].disturbance.coulomb2 = 0.0;
  const auto together = run_all(some_rub, usual_lockstep);
  for (std::size_t i = 0; i < some_rub.size(); i += 6) {
    EXPECT_TRUE(same_bits(runner->run(some_rub[i]), together[i])) << "alone: trial " << i;
  }
}

TEST(ImperfectTrials, MoreOfEitherKindThanMayWaitAreAllRun) {
  TrialParameters at_goal;
  at_goal.start = {0.0, 0.7853981633974483, 0.0, 0.0};
  std::vector<TrialParameters> trials(2'000, at_goal);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (i < 500 || (i > 1'200 && i % 2 == 0)) trials[i].actuator.gain = 1.1;
  }
  const auto outcomes = run_all(trials, usual_lockstep);
  EXPECT_EQ(std::ranges::count(outcomes, Status::converged, &TrialOutcome::status), 2'000);
}

class EveryMethodWithImperfections : public EveryMethod {};

TEST_P(EveryMethodWithImperfections, ReplayHasTheBitsOfTheRunAndShowsTheForceApplied) {
  const std::vector<TrialParameters> trials = imperfect_study(6);
  const auto outcomes = run_all(trials, integrator());
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const Trajectory trajectory = replay(trials[i], integrator(), 0.05);
    EXPECT_TRUE(same_bits(trajectory.outcome, outcomes[i])) << "trial " << i;
    double peak = 0.0;
    for (const TrajectorySample& sample : trajectory.samples) peak = std::max(peak, std::abs(sample.tau));
    EXPECT_LE(peak, trials[i].actuator.max_force);
    EXPECT_GT(peak, 0.1);
  }
}

TEST_P(EveryMethodWithImperfections, ABiasedTrialConvergesBesideTheGoalAndReportsTheTruth) {
  TrialParameters trial;
  trial.sensor.bias = {0.05, -0.03, 0.0, 0.0};
  const TrialOutcome outcome = run(trial);
  ASSERT_EQ(outcome.status, Status::converged);
  EXPECT_NEAR(outcome.end_state.q1, -0.05, 0.02);
  EXPECT_NEAR(outcome.active_error, 0.05, 0.02);
  EXPECT_NEAR(outcome.end_state.q2, trial.goal.q2 + 0.03, 0.005);
  EXPECT_GT(outcome.passive_error, 0.025);
  // The same course as a start that is shifted the other way.
  TrialParameters shifted;
  shifted.start.q1 += 0.05;
  const TrialOutcome moved = run(shifted);
  trial.sensor.bias.q2 = 0.0;
  const TrialOutcome biased = run(trial);
  EXPECT_NEAR(biased.end_time, moved.end_time, 1e-5);
  EXPECT_EQ(biased.cycles, moved.cycles);
}

TEST_P(EveryMethodWithImperfections, AVelocityBiasBeyondTheTolerancesReachKeepsAlignFromEnding) {
  // The reading's error settles at |bias| sqrt(1 + (kd / kp)^2).
  const double reach = 1e-3 / std::sqrt(1.0 + 25.0 / 49.0);
  TrialParameters trial;
  trial.controller.horizon = 20.0;
  trial.sensor.bias.q1_dot = -0.99 * reach;
  EXPECT_GT(run(trial).cycles, 0U);
  trial.sensor.bias.q1_dot = -1.5 * reach;  // past the overshoot of the law, a thousandth of the way
  EXPECT_EQ(run(trial).cycles, 0U);
  EXPECT_EQ(run(trial).status, Status::timeout);
}

TEST_P(EveryMethodWithImperfections, NoiseOfAnotherSeedIsAnotherTrialAndNoneIsNone) {
  TrialParameters trial;
  const TrialOutcome quiet = run(trial);
  trial.sensor.noise = {1e-4, 1e-4, 1e-4, 1e-4};
  std::set<double> times{quiet.end_time};
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    trial.sensor.noise_seed = seed;
    times.insert(run(trial).end_time);
  }
  EXPECT_EQ(times.size(), 4U);
}

INSTANTIATE_TEST_SUITE_P(, EveryMethodWithImperfections, every_method(), method_name);

bool same_course_of_phases(const TrialOutcome& a, const TrialOutcome& b) {
  return a.status == b.status && a.cycles == b.cycles && a.swings == b.swings && a.alignments == b.alignments;
}

/// The largest relative difference of what two trials asked of the first joint.
double exertion_difference(const TrialOutcome& a, const TrialOutcome& b) {
  const auto relative = [](double x, double y) { return std::abs(x - y) / std::abs(y); };
  return std::max({relative(a.effort, b.effort), relative(a.peak_acceleration, b.peak_acceleration),
                   relative(a.peak_force, b.peak_force), relative(a.peak_stroke, b.peak_stroke)});
}

/// Two engines, two methods, one answer: the same course, ending at the same time, with the same effort and peaks. Both
/// at fine tolerances: long trials amplify a step's error ten-thousandfold.
TEST(ImperfectTrials, LockstepAgreesWithTheReference) {
  const std::vector<TrialParameters> trials = imperfect_study(compared_trials());
  const auto ours = run_all(trials, {IntegratorChoice::Method::lockstep, 1e-12});
  const auto reference = run_all(trials, {IntegratorChoice::Method::cvode, 1e-13});
  std::vector<double> differences;
  std::vector<double> exertions;
  std::size_t converged = 0;
  std::size_t other_courses = 0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    converged += reference[i].status == Status::converged ? 1U : 0U;
    if (!same_course_of_phases(ours[i], reference[i])) {
      ++other_courses;
      continue;
    }
    exertions.push_back(exertion_difference(ours[i], reference[i]));
    if (ours[i].status == Status::converged) differences.push_back(std::abs(ours[i].end_time - reference[i].end_time));
  }
  EXPECT_LE(other_courses, trials.size() / 500);
  EXPECT_GT(converged, trials.size() / 10) << "too few to say anything";
  ASSERT_FALSE(differences.empty());
  std::ranges::sort(differences);
  std::ranges::sort(exertions);
  RecordProperty("other_courses", std::to_string(other_courses));
  RecordProperty("median", std::to_string(differences[differences.size() / 2]));
  RecordProperty("largest", std::to_string(differences.back()));
  std::printf(
      "%zu of %zu trials take another course; settling times apart: median %.3g s, largest %.3g s; effort and "
      "peaks: median %.3g, nine in ten within %.3g, largest %.3g\n",
      other_courses, trials.size(), differences[differences.size() / 2], differences.back(),
      exertions[exertions.size() / 2], exertions[exertions.size() * 9 / 10], exertions.back());
  EXPECT_LT(differences[differences.size() / 2], 1e-7);
  EXPECT_LT(differences.back(), 1e-5);
  EXPECT_LT(exertions[exertions.size() / 2], 1e-7);
  // Long trials amplify rounding, their efforts with their settling times.
  EXPECT_LT(exertions[exertions.size() * 9 / 10], 1e-6);
}

/// The rounding of friction's rate made CVODE's steps shrink without end in the 9th cycle of this trial.
TEST(ImperfectTrials, RoundingDoesNotStopTheReferenceAtItsFinest) {
  const TrialParameters trial = imperfect_study(20)[19];
  const TrialOutcome ours = make_runner({IntegratorChoice::Method::lockstep, 1e-12})->run(trial);
  const TrialOutcome reference = make_runner({IntegratorChoice::Method::cvode, 1e-12})->run(trial);
  EXPECT_EQ(reference.status, Status::converged);
  EXPECT_TRUE(same_course_of_phases(ours, reference));
  EXPECT_NEAR(ours.end_time, reference.end_time, 1e-5);
}

}  // namespace
}  // namespace steerstat::testing
