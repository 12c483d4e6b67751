#include "trial/lockstep_runner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>
#include <vector>

#include "core/elementary.hpp"
#include "nightly.hpp"
#include "study/plan.hpp"
#include "study/spec_json.hpp"
#include "trial/replay.hpp"

namespace steerstat {
namespace {

/// Trials to compare with the reference, which is slow; slower still beside sanitizers.
std::uint64_t compared_trials() {
  return testing::is_sanitized ? 50 : testing::is_nightly() ? 5000 : 1500;
}

std::vector<TrialParameters> combined_trials(std::uint64_t first, std::uint64_t count) {
  const std::string path = STEERSTAT_SOURCE_DIR "/studies/specs/robustness/combined.json";
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  Study study = decode_study(text.str(), {});
  study.sampling.trials = first + count;  // the draws do not depend on how many there are
  const Plan plan(study);
  std::vector<TrialParameters> trials;
  for (std::uint64_t i = first; i < first + count; ++i) trials.push_back(plan.parameters(i));
  return trials;
}

/// Serves trials in the order given, and keeps the outcomes by index.
class ListedTrials final : public TrialStream {
 public:
  ListedTrials(const std::vector<TrialParameters>& trials, std::vector<std::uint64_t> order)
      : trials_(trials), order_(std::move(order)) {}

  bool next(std::uint64_t& index, TrialParameters& parameters) override {
    if (served_ == order_.size()) return false;
    index = order_[served_++];
    parameters = trials_[index];
    return true;
  }
  void finished(std::uint64_t index, const TrialOutcome& outcome) override {
    EXPECT_TRUE(outcomes.emplace(index, outcome).second) << "trial " << index << " reported twice";
  }

  std::map<std::uint64_t, TrialOutcome> outcomes;

 private:
  const std::vector<TrialParameters>& trials_;
  std::vector<std::uint64_t> order_;
  std::size_t served_{0};
};

std::map<std::uint64_t, TrialOutcome> run(TrialRunner& runner, const std::vector<TrialParameters>& trials,
                                          std::vector<std::uint64_t> order) {
  ListedTrials stream(trials, std::move(order));
  runner.run(stream);
  return stream.outcomes;
}

std::vector<std::uint64_t> all_of(const std::vector<TrialParameters>& trials) {
  std::vector<std::uint64_t> order(trials.size());
  std::iota(order.begin(), order.end(), std::uint64_t{0});
  return order;
}

TEST(LockstepRunner, OutcomesAreTheSameBitsOnEveryInstructionSet) {
  const std::vector<TrialParameters> trials = combined_trials(0, 200);
  LockstepRunner portable(1e-9, InstructionSet::portable);
  const auto expected = run(portable, trials, all_of(trials));
  ASSERT_EQ(expected.size(), trials.size());
  for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2}) {
    if (!supports(set)) continue;
    LockstepRunner runner(1e-9, set);
    EXPECT_EQ(run(runner, trials, all_of(trials)), expected) << name_of(set);
  }
}

TEST(LockstepRunner, AnOutcomeIsTheSameBitsAloneInACrowdAndInAnyOrder) {
  const std::vector<TrialParameters> trials = combined_trials(0, 120);
  LockstepRunner runner(1e-9, best_instruction_set());
  const auto expected = run(runner, trials, all_of(trials));
  std::vector<std::uint64_t> backwards = all_of(trials);
  std::reverse(backwards.begin(), backwards.end());
  EXPECT_EQ(run(runner, trials, backwards), expected);
  for (std::uint64_t i = 0; i < trials.size(); i += 7) {
    EXPECT_EQ(run(runner, trials, {i}).at(i), expected.at(i)) << "alone: trial " << i;
  }
  const auto last = run(runner, trials, {5, 6, 7, 8, 3});
  EXPECT_EQ(last.at(3), expected.at(3)) << "as the last of a block";
}

TEST(LockstepRunner, GuardsThatFireInEveryLaneAtOnceFireWhereTheyDoAlone) {
  for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2, InstructionSet::portable}) {
    if (!supports(set)) continue;
    LockstepRunner runner(1e-9, set);
    for (const Policy policy : {Policy::paper, Policy::robust}) {  // the robust align has three guards
      TrialParameters trial = combined_trials(3, 1).front();
      trial.controller.policy = policy;
      const TrialOutcome alone = runner.TrialRunner::run(trial);
      const std::vector<TrialParameters> copies(100, trial);
      for (const auto& [i, outcome] : run(runner, copies, all_of(copies))) {
        EXPECT_EQ(outcome, alone) << name_of(set) << ", " << name_of(policy) << ", copy " << i;
      }
    }
  }
}

TEST(LockstepRunner, ReplayHasTheBitsOfTheRun) {
  const std::vector<TrialParameters> trials = combined_trials(0, 60);
  LockstepRunner runner(1e-9, best_instruction_set());
  const auto outcomes = run(runner, trials, all_of(trials));
  for (std::uint64_t i = 0; i < trials.size(); ++i) {
    const Trajectory trajectory = replay(trials[i], {IntegratorChoice::Method::lockstep, 1e-9}, 0.05);
    EXPECT_EQ(trajectory.outcome, outcomes.at(i)) << "trial " << i;
    EXPECT_EQ(trajectory.samples.back().state, outcomes.at(i).end_state);
    EXPECT_EQ(trajectory.samples.back().t, outcomes.at(i).end_time);
  }
}

TEST(LockstepRunner, ATrialThatIsNotFiniteEndsWithAStatusAndDisturbsNoOther) {
  std::vector<TrialParameters> trials = combined_trials(0, 40);
  LockstepRunner runner(1e-9, best_instruction_set());
  const auto expected = run(runner, trials, all_of(trials));
  trials[7].start.q2_dot = std::numeric_limits<double>::quiet_NaN();
  trials[11].plant.f2 = 1e16;
  auto outcomes = run(runner, trials, all_of(trials));
  EXPECT_EQ(outcomes.at(7).status, Status::diverged);
  EXPECT_EQ(outcomes.at(11).status, Status::integrator_failed);
  for (std::uint64_t i = 0; i < trials.size(); ++i) {
    if (i == 7 || i == 11) continue;
    EXPECT_EQ(outcomes.at(i), expected.at(i)) << "trial " << i;
  }
}

TEST(LockstepRunner, NoLaneIdlesWhileTrialsRemain) {
  const std::vector<TrialParameters> trials = combined_trials(0, 20000);
  LockstepRunner runner(1e-9, best_instruction_set());
  (void)run(runner, trials, all_of(trials));
  const LockstepEngine::Counters& counters = runner.engine().counters();
  const double occupancy = static_cast<double>(counters.lane_steps) / static_cast<double>(counters.lane_slots);
  EXPECT_GT(occupancy, 0.99);
}

TEST(LockstepRunner, ConvergesInThePapersTimesAndMeetsTheDipFixture) {
  LockstepRunner runner(1e-9, best_instruction_set());
  TrialParameters nominal;
  nominal.controller.realignment = Realignment::never;
  nominal.controller.alignment.tolerance = 3.33e-4;
  const TrialOutcome paper = runner.TrialRunner::run(nominal);
  EXPECT_EQ(paper.status, Status::converged);
  EXPECT_EQ(paper.cycles, 9u);
  EXPECT_NEAR(paper.end_time, 47.270, 0.02);
  EXPECT_NEAR(paper.end_state.q2, 0.78115, 1e-4);

  TrialParameters dip;
  dip.start = {0.0603608156672828, -0.21585049184725724, -0.0986681884420404, 0.06331720478758573};
  dip.plant.m1 = 1.1022245230829437;
  dip.plant.m2 = 0.9207837842362312;
  dip.plant.f1 = 0.014927178814451658;
  dip.plant.f2 = 0.0032548929628400283;
  const TrialOutcome outcome = runner.TrialRunner::run(dip);
  EXPECT_EQ(outcome.status, Status::converged);
  EXPECT_NEAR(outcome.end_time, 27.2236, 1e-4);
  EXPECT_EQ(outcome.cycles, 7u);
  EXPECT_EQ(outcome.alignments, 7u);
}

/// Two engines, two methods, one answer: the same decisions at the same times.
TEST(LockstepRunner, AgreesWithTheReferenceOnTheCombinedStudy) {
  const std::vector<TrialParameters> trials = combined_trials(0, compared_trials());
  LockstepRunner lockstep(1e-10, best_instruction_set());
  const auto reference_runner = make_runner({IntegratorChoice::Method::cvode, 1e-12});
  const auto ours = run(lockstep, trials, all_of(trials));
  const auto reference = run(*reference_runner, trials, all_of(trials));
  std::uint64_t agreed = 0;
  std::vector<double> differences;
  for (std::uint64_t i = 0; i < trials.size(); ++i) {
    const TrialOutcome& a = ours.at(i);
    const TrialOutcome& b = reference.at(i);
    if (a.status == b.status && a.cycles == b.cycles && a.swings == b.swings) {
      ++agreed;
      if (a.status != Status::converged) continue;
      differences.push_back(std::abs(a.end_time - b.end_time));
      if (differences.back() > 1e-5) {
        std::printf("trial %llu settles %.3g s apart\n", static_cast<unsigned long long>(i), differences.back());
      }
    } else {
      std::printf("trial %llu: %s after %u cycles, %u swings at %.6f s; reference %s after %u, %u at %.6f s\n",
                  static_cast<unsigned long long>(i), name_of(a.status).data(), a.cycles, a.swings, a.end_time,
                  name_of(b.status).data(), b.cycles, b.swings, b.end_time);
    }
  }
  std::sort(differences.begin(), differences.end());
  std::printf("%llu of %llu agree on status, cycles and swings; settling times apart: median %.3g s, largest %.3g s\n",
              static_cast<unsigned long long>(agreed), static_cast<unsigned long long>(trials.size()),
              differences[differences.size() / 2], differences.back());
  EXPECT_GT(static_cast<double>(agreed), 0.999 * static_cast<double>(trials.size()));
  EXPECT_LT(differences.back(), 1e-5);
}

}  // namespace
}  // namespace steerstat
