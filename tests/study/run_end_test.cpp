// Runs that end before their last trial, by a request or by what throws, and what is told meanwhile.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "echo_runner.hpp"

namespace steerstat {
namespace {

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

class InterruptedRunOnAnEngine : public ::testing::TestWithParam<IntegratorChoice::Method> {};

TEST_P(InterruptedRunOnAnEngine, KeepsWhatAWholeRunHas) {
  Study study = spec_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "horizon": 30, "sampling": {"trials": 1},
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

INSTANTIATE_TEST_SUITE_P(Engines, InterruptedRunOnAnEngine,
                         ::testing::Values(IntegratorChoice::Method::lockstep, IntegratorChoice::Method::cvode),
                         [](const auto& one) {
                           return std::string(IntegratorChoice::method_names[static_cast<std::size_t>(one.param)]);
                         });

/// What is left of an echo's run when a stop is requested as such a trial ends.
StudyResult run_stopped(const Study& study, unsigned threads, const std::function<bool(std::uint64_t)>& stops_at) {
  std::stop_source stop;
  RunOptions options = echo_options(threads, [&](std::uint64_t index) {
    if (stops_at(index)) stop.request_stop();
  });
  options.stop = stop.get_token();
  return run_study(study, options);
}

TEST(RunStudy, AStopKeepsExactlyTheBlocksBegun) {
  const Study study = drawn_study(1000);
  // Trial 0 is finished while the group of seven it came with is all that has been claimed: one block.
  const StudyResult result = run_stopped(study, 1, [](std::uint64_t index) { return index == 0; });
  EXPECT_FALSE(result.complete);
  EXPECT_EQ(result.trials.index.size(), block_size(study));
  expect_kept_prefix(study, result.trials);
}

TEST(RunStudy, AStopOnThreeThreadsKeepsWholeBlocks) {
  const Study study = drawn_study(10000);
  // Whoever is first there stops all: nobody runs away meanwhile.
  const StudyResult result = run_stopped(study, 3, [](std::uint64_t index) { return index >= 1000; });
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
  const StudyResult result = run_stopped(drawn_study(40), 1, [](std::uint64_t index) { return index == 39; });
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(result.trials.index.size(), 40U);
}

struct BrokenWorker : std::runtime_error {
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
        throw BrokenWorker("trial 20");
      }
      while (index > 100 && !broken) std::this_thread::yield();  // nobody runs away meanwhile
    });
    EXPECT_THROW(run_study(drawn_study(500000), options), BrokenWorker);
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
    if (++calls == 2) throw BrokenWorker("progress");
  };
  EXPECT_THROW(run_study(drawn_study(100000), options), BrokenWorker);
  EXPECT_LT(run.load(), 100000U);
}

TEST(RunStudy, WhatTheLastProgressCallThrowsIsNotLost) {
  RunOptions options = echo_options(1);
  options.on_progress = [](const Progress& progress) {
    if (progress.completed == progress.requested) throw BrokenWorker("the last report");
  };
  EXPECT_THROW(run_study(drawn_study(10), options), BrokenWorker);
}

}  // namespace
}  // namespace steerstat
