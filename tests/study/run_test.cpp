#include "study/run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <mutex>

#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include "core/errors.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

Study study_of(const std::string& spec) {
  return decode_study(spec, {});
}

/// Cheap stand-in for an engine: the outcome tells its trial's parameters, every fifth draw fails. Takes trials in
/// groups that straddle blocks and finishes each group backwards, as lanes may.
class EchoRunner final : public TrialRunner {
 public:
  using OnTrial = std::function<void(std::uint64_t index)>;

  explicit EchoRunner(OnTrial on_trial = {}) : on_trial_(std::move(on_trial)) {}

  static TrialOutcome outcome_of(const TrialParameters& parameters) {
    TrialOutcome outcome;
    const double digits = parameters.start.q1 * 1e6;
    const bool fails = digits - 5.0 * std::floor(digits / 5.0) < 1.0;
    outcome.status = fails ? Status::timeout : Status::converged;
    outcome.end_time = parameters.plant.m1;
    outcome.end_state = parameters.start;
    return outcome;
  }

  using TrialRunner::run;
  void run(TrialStream& stream) override {
    struct Trial {
      std::uint64_t index{};
      TrialParameters parameters{};
    };
    bool more = true;
    while (more) {
      std::vector<Trial> group;
      Trial trial;
      while (group.size() < 7 && (more = stream.next(trial.index, trial.parameters))) group.push_back(trial);
      for (auto it = group.rbegin(); it != group.rend(); ++it) {
        if (on_trial_) on_trial_(it->index);
        stream.finished(it->index, outcome_of(it->parameters));
      }
    }
    std::uint64_t index = 0;
    TrialParameters parameters;
    EXPECT_FALSE(stream.next(index, parameters)) << "a dry stream stays dry";
  }

 private:
  OnTrial on_trial_;
};

RunOptions echo_options(unsigned threads, EchoRunner::OnTrial on_trial = {}) {
  RunOptions options;
  options.threads = threads;
  options.make_runner = [on_trial](const IntegratorChoice&) { return std::make_unique<EchoRunner>(on_trial); };
  return options;
}

Study drawn_study(std::uint64_t trials, const std::string& more = "") {
  return study_of(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "initial_state": {"q1": {"uniform": [-1, 1]}},
                      "integrator": {"method": "cvode"}, "audit": {"trials": 0}, "sampling": {"trials": )" +
                  std::to_string(trials) + "}" + more + "}");
}

void expect_kept_prefix(const Study& study, const TrialTable& trials) {
  const Plan plan(study);
  ASSERT_EQ(trials.index.size(), trials.outcomes.size());
  for (std::uint64_t row = 0; row < trials.index.size(); ++row) {
    EXPECT_EQ(trials.index[row], row);
    EXPECT_TRUE(same_bits(trials.outcomes[row], EchoRunner::outcome_of(plan.parameters(row)))) << "trial " << row;
  }
}

class RunStudyOnAnEngine : public testing::TestWithParam<IntegratorChoice::Method> {};

TEST_P(RunStudyOnAnEngine, OutcomesAreTheSameBitsOnOneTwoAndThreeThreads) {
  Study study = study_of(R"({
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

/// Runs trials on an engine and requests a stop as soon as the first has finished.
class StoppingRunner final : public TrialRunner {
 public:
  StoppingRunner(std::unique_ptr<TrialRunner> engine, std::stop_source& stop)
      : engine_(std::move(engine)), stop_(stop) {}

  using TrialRunner::run;
  void run(TrialStream& stream) override {
    struct Watch final : TrialStream {
      Watch(TrialStream& watched, std::stop_source& source) : stream(watched), stop(source) {}
      bool next(std::uint64_t& index, TrialParameters& parameters) override { return stream.next(index, parameters); }
      void finished(std::uint64_t index, const TrialOutcome& outcome) override {
        stop.request_stop();
        stream.finished(index, outcome);
      }
      TrialStream& stream;
      std::stop_source& stop;
    };
    Watch watch(stream, stop_);
    engine_->run(watch);
  }

 private:
  std::unique_ptr<TrialRunner> engine_;
  std::stop_source& stop_;
};

TEST_P(RunStudyOnAnEngine, WhatAStoppedRunKeepsIsWhatAWholeRunHas) {
  Study study = study_of(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "horizon": 30, "sampling": {"trials": 1},
      "audit": {"trials": 0}})");
  study.integrator.method = GetParam();
  study.sampling.trials = 10 * block_size(study);
  RunOptions options;
  options.threads = 2;
  const StudyResult whole = run_study(study, options);
  std::stop_source stop;
  options.stop = stop.get_token();
  options.make_runner = [&](const IntegratorChoice& integrator) {
    return std::make_unique<StoppingRunner>(make_runner(integrator), stop);
  };
  const StudyResult stopped = run_study(study, options);
  const std::uint64_t kept = stopped.trials.outcomes.size();
  EXPECT_FALSE(stopped.complete);
  EXPECT_GT(kept, 0U);
  EXPECT_EQ(kept % block_size(study), 0U);
  for (std::uint64_t row = 0; row < kept; ++row) {
    EXPECT_TRUE(same_bits(stopped.trials.outcomes[row], whole.trials.outcomes[row])) << "trial " << row;
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, RunStudyOnAnEngine,
                         testing::Values(IntegratorChoice::Method::lockstep, IntegratorChoice::Method::cvode),
                         [](const auto& one) {
                           return std::string(IntegratorChoice::method_names[static_cast<std::size_t>(one.param)]);
                         });

TEST(RunStudy, OutcomesAreTheSameBitsOnEveryInstructionSetAndTheResultSaysWhichItWas) {
  const Study study = study_of(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "horizon": 60,
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
  EXPECT_FALSE(run_study(study_of(R"({"horizon": 1, "integrator": {"method": "cvode"}})"), {}).simd);
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

TEST(RunStudy, AStopKeepsExactlyTheBlocksBegun) {
  const Study study = drawn_study(1000);
  // Trial 0 is finished while the group of seven it came with is all that has been claimed: one block.
  std::stop_source stop;
  RunOptions options = echo_options(1, [&](std::uint64_t index) {
    if (index == 0) stop.request_stop();
  });
  options.stop = stop.get_token();
  const StudyResult result = run_study(study, options);
  EXPECT_FALSE(result.complete);
  EXPECT_EQ(result.trials.index.size(), block_size(study));
  expect_kept_prefix(study, result.trials);
}

TEST(RunStudy, AStopOnThreeThreadsKeepsWholeBlocks) {
  const Study study = drawn_study(10000);
  std::stop_source stop;
  RunOptions options = echo_options(3, [&](std::uint64_t index) {
    if (index >= 1000) stop.request_stop();  // whoever is first there: nobody runs away meanwhile
  });
  options.stop = stop.get_token();
  const StudyResult result = run_study(study, options);
  EXPECT_FALSE(result.complete);
  EXPECT_GT(result.trials.index.size(), 1000U);
  EXPECT_LT(result.trials.index.size(), 10000U);
  EXPECT_EQ(result.trials.index.size() % block_size(study), 0U);
  expect_kept_prefix(study, result.trials);
}

TEST(RunStudy, AStopBeforeTheFirstTrialKeepsNone) {
  std::stop_source stop;
  stop.request_stop();
  RunOptions options = echo_options(2);
  options.stop = stop.get_token();
  const StudyResult result = run_study(drawn_study(100), options);
  EXPECT_FALSE(result.complete);
  EXPECT_TRUE(result.trials.index.empty());
  EXPECT_TRUE(result.trials.outcomes.empty());
}

TEST(RunStudy, AStopDuringTheLastBlockComesTooLateToCutTheRun) {
  const Study study = drawn_study(40);
  std::stop_source stop;
  RunOptions options = echo_options(1, [&](std::uint64_t index) {
    if (index == 39) stop.request_stop();
  });
  options.stop = stop.get_token();
  const StudyResult result = run_study(study, options);
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(result.trials.index.size(), 40U);
}

struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

TEST(RunStudy, WhatAWorkerThrowsIsRethrownAndEndsTheOthers) {
  for (const unsigned threads : {1U, 3U}) {
    std::atomic<std::uint64_t> run{0};
    std::atomic<bool> broken{false};
    const RunOptions options = echo_options(threads, [&](std::uint64_t index) {
      ++run;
      if (index == 20) {
        broken = true;
        throw Broken("trial 20");
      }
      while (index > 100 && !broken) std::this_thread::yield();  // nobody runs away meanwhile
    });
    EXPECT_THROW(run_study(drawn_study(500000), options), Broken);
    EXPECT_LT(run.load(), 500000U);
  }
}

TEST(RunStudy, ARunnerThatCannotBeMadeIsReported) {
  RunOptions options;
  options.threads = 2;
  options.make_runner = [](const IntegratorChoice&) -> std::unique_ptr<TrialRunner> { throw RunFailure("no engine"); };
  EXPECT_THROW(run_study(drawn_study(100), options), RunFailure);
}

TEST(RunStudy, ARunnerThatDropsTrialsIsReported) {
  class Dropper final : public TrialRunner {
   public:
    using TrialRunner::run;
    void run(TrialStream& stream) override {
      std::uint64_t index = 0;
      TrialParameters parameters;
      stream.next(index, parameters);
    }
  };
  RunOptions options;
  options.threads = 1;
  options.make_runner = [](const IntegratorChoice&) { return std::make_unique<Dropper>(); };
  EXPECT_THROW(run_study(drawn_study(10), options), std::logic_error);
}

TEST(RunStudy, ProgressGrowsFromNothingToEverythingOneCallAtATime) {
  RunOptions options =
      echo_options(2, [](std::uint64_t) { std::this_thread::sleep_for(std::chrono::milliseconds(2)); });
  std::vector<Progress> seen;
  std::atomic<int> inside{0};
  options.on_progress = [&](const Progress& progress) {
    EXPECT_EQ(++inside, 1);
    seen.push_back(progress);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    --inside;
  };
  run_study(drawn_study(500), options);
  ASSERT_GE(seen.size(), 3U);  // half a second at least: the start, some on the way, the end
  EXPECT_LT(seen.front().completed, 100U);
  EXPECT_EQ(seen.back().completed, 500U);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_EQ(seen[i].requested, 500U);
    if (i == 0) continue;
    EXPECT_GE(seen[i].completed, seen[i - 1].completed);
    EXPECT_GE(seen[i].elapsed, seen[i - 1].elapsed);
  }
}

TEST(RunStudy, WhatTheProgressCallbackThrowsIsRethrownAndEndsTheRun) {
  std::atomic<std::uint64_t> run{0};
  RunOptions options = echo_options(2, [&](std::uint64_t) {
    ++run;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  int calls = 0;
  options.on_progress = [&](const Progress&) {
    if (++calls == 2) throw Broken("progress");
  };
  EXPECT_THROW(run_study(drawn_study(100000), options), Broken);
  EXPECT_LT(run.load(), 100000U);
}

TEST(RunStudy, WhatTheLastProgressCallThrowsIsNotLost) {
  RunOptions options = echo_options(1);
  options.on_progress = [](const Progress& progress) {
    if (progress.completed == progress.requested) throw Broken("the last report");
  };
  EXPECT_THROW(run_study(drawn_study(10), options), Broken);
}

TEST(RunStudy, RetainsTheFirstTrialsAndTheFirstFailuresByIndex) {
  const Study study = study_of(R"({"plant": {"f2": {"uniform": [0, 0.06]}}, "integrator": {"method": "cvode"},
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
  EXPECT_THAT(retained, testing::ElementsAreArray(expected));  // ascending, each once
}

TEST(RunStudy, RetainsAllWhereFewerFinishedThanAskedFor) {
  const Study study = study_of(R"({"initial_state": {"q1": {"uniform": [0.9, 1.1]}},
      "integrator": {"method": "cvode"}, "horizon": 1, "sampling": {"trials": 3}, "audit": {"trials": 0},
      "retain": {"trajectories": {"failed": 100, "first": 100}}})");
  EXPECT_EQ(run_study(study, {}).trajectories.size(), 3U);
}

}  // namespace
}  // namespace steerstat
