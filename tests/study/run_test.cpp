#include "study/run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/errors.hpp"
#include "echo_runner.hpp"

namespace steerstat {
namespace {

class RunStudyOnAnEngine : public ::testing::TestWithParam<IntegratorChoice::Method> {};

TEST_P(RunStudyOnAnEngine, OutcomesAreTheSameBitsOnOneTwoAndThreeThreads) {
  Study study = spec_study(R"({
      "plant": {"m1": {"uniform": [0.8, 1.2]}, "m2": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]},
                "coulomb1": {"discrete": {"values": [0, 0.001], "weights": [1, 1]}}},
      "sensor": {"noise": {"q1": {"discrete": {"values": [0, 0.0001], "weights": [1, 1]}}}},
      "initial_state": {"q1": {"uniform": [-1, 1]}, "q2": {"uniform": [-3.1, 3.1]}},
      "horizon": 60, "sampling": {"trials": 1}, "audit": {"trials": 0}})");
  study.integrator.method = GetParam();
  study.sampling.trials = 4 * block_size(study) + 3;
  RunOptions options;
  options.threads = 1;
  const StudyResult one = run_study(study, options);
  EXPECT_TRUE(one.complete);
  ASSERT_EQ(one.trials.outcomes.size(), study.sampling.trials);
  for (const unsigned threads : {2U, 3U}) {
    options.threads = threads;
    const StudyResult other = run_study(study, options);
    EXPECT_EQ(other.threads, threads);
    ASSERT_EQ(other.trials.index, one.trials.index);
    for (std::size_t row = 0; row < one.trials.outcomes.size(); ++row) {
      EXPECT_TRUE(same_bits(other.trials.outcomes[row], one.trials.outcomes[row])) << "trial " << row;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, RunStudyOnAnEngine,
                         ::testing::Values(IntegratorChoice::Method::lockstep, IntegratorChoice::Method::cvode),
                         [](const auto& one) {
                           return std::string(IntegratorChoice::method_names[static_cast<std::size_t>(one.param)]);
                         });

TEST(RunStudy, OutcomesAreTheSameBitsOnEveryInstructionSetAndTheResultSaysWhichItWas) {
  const Study study = spec_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "horizon": 60,
      "sampling": {"trials": 150}, "audit": {"trials": 0}})");
  const StudyResult portable = run_study(study, {.simd = InstructionSet::portable});
  EXPECT_EQ(portable.simd, InstructionSet::portable);
  for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
    if (!supports(set)) {
      EXPECT_THROW(run_study(study, {.simd = set}), BadUsage);
      continue;
    }
    const StudyResult other = run_study(study, {.simd = set});
    EXPECT_EQ(other.simd, set);
    for (std::size_t row = 0; row < 150; ++row) {
      EXPECT_TRUE(same_bits(other.trials.outcomes[row], portable.trials.outcomes[row])) << "trial " << row;
    }
  }
}

TEST(RunStudy, OnTheReferenceUsesNoInstructionSet) {
  EXPECT_FALSE(run_study(spec_study(R"({"horizon": 1, "integrator": {"method": "cvode"}})"), {}).simd);
}

TEST(RunStudy, EveryTrialIsStoredAtItsIndexHoweverTrialsFinish) {
  for (const std::uint64_t trials : {1U, 15U, 16U, 17U, 500U}) {  // one block has 16 trials
    for (const unsigned threads : {1U, 3U}) {
      const Study study = drawn_study(trials);
      const StudyResult result = run_study(study, echo_options(threads));
      EXPECT_TRUE(result.complete);
      EXPECT_EQ(result.trials.index.size(), trials);
      expect_kept_prefix(study, result.trials);
    }
  }
}

TEST(RunStudy, EveryCellOfASweepIsRun) {
  const Study study = drawn_study(10, R"(, "controller": {"contraction": {"eta1": {"sweep": [0.3, 0.5, 0.7]}}})");
  const StudyResult result = run_study(study, echo_options(2));
  EXPECT_EQ(result.trials.index.size(), 30U);
  expect_kept_prefix(study, result.trials);
}

TEST(RunStudy, UsesNoMoreWorkersThanBlocks) {
  EXPECT_EQ(run_study(drawn_study(16), echo_options(3)).threads, 1U);
  EXPECT_EQ(run_study(drawn_study(17), echo_options(3)).threads, 2U);
  EXPECT_EQ(run_study(drawn_study(100), echo_options(3)).threads, 3U);
  EXPECT_GE(run_study(drawn_study(100), echo_options(0)).threads, 1U);
}

TEST(RunStudy, EveryWorkerRunsARunnerThatItMadeItself) {
  std::mutex mutex;
  std::set<std::thread::id> makers;
  std::set<std::thread::id> users;
  RunOptions options;
  options.threads = 3;
  options.make_runner = [&](const IntegratorChoice&) {
    const std::thread::id maker = std::this_thread::get_id();
    {
      const std::lock_guard lock(mutex);
      makers.insert(maker);
    }
    return std::make_unique<EchoRunner>([&, maker](std::uint64_t) {
      const std::lock_guard lock(mutex);
      users.insert(std::this_thread::get_id());
      EXPECT_EQ(std::this_thread::get_id(), maker);
    });
  };
  run_study(drawn_study(1000), options);
  EXPECT_TRUE(std::includes(makers.begin(), makers.end(), users.begin(), users.end()));
}

TEST(RunStudy, RetainsTheFirstTrialsAndTheFirstFailuresByIndex) {
  const Study study = spec_study(R"({"plant": {"f2": {"uniform": [0, 0.06]}}, "integrator": {"method": "cvode"},
      "horizon": 120, "sampling": {"trials": 24}, "retain": {"trajectories": {"failed": 3, "first": 2}},
      "audit": {"trials": 0}})");
  RunOptions options;
  options.threads = 2;
  const StudyResult result = run_study(study, options);
  std::set<std::uint64_t> expected{0, 1};
  std::uint64_t failures = 0;
  for (std::uint64_t i = 0; i < 24 && failures < 3; ++i) {
    if (result.trials.outcomes[i].status == Status::converged) continue;
    expected.insert(i);
    ++failures;
  }
  ASSERT_EQ(failures, 3U) << "the study is meant to fail sometimes";
  std::vector<std::uint64_t> retained;
  for (const StudyResult::Retained& one : result.trajectories) {
    retained.push_back(one.index);
    EXPECT_TRUE(same_bits(one.trajectory.outcome, result.trials.outcomes[one.index]));
    EXPECT_FALSE(one.trajectory.samples.empty());
  }
  EXPECT_THAT(retained, ::testing::ElementsAreArray(expected));  // ascending, each once
}

TEST(RunStudy, RetainsAllWhereFewerFinishedThanAskedFor) {
  const Study study = spec_study(R"({"initial_state": {"q1": {"uniform": [0.9, 1.1]}},
      "integrator": {"method": "cvode"}, "horizon": 1, "sampling": {"trials": 3}, "audit": {"trials": 0},
      "retain": {"trajectories": {"failed": 100, "first": 100}}})");
  EXPECT_EQ(run_study(study, {}).trajectories.size(), 3U);
}

}  // namespace
}  // namespace steerstat
