// What a run hands over while it goes on.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <utility>

#include "resumable_study.hpp"

namespace steerstat {
namespace {

/// Notes what a run hands over. @param on_take  called before that
class NotingSink final : public OutcomeSink {
 public:
  explicit NotingSink(std::function<void()> on_take = {}) : on_take_(std::move(on_take)) {}
  void take(std::uint64_t begin, std::span<const TrialOutcome> outcomes) override {
    ++calls;
    if (on_take_) on_take_();
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      taken.trials.index.push_back(begin + i);
      taken.trials.outcomes.push_back(outcomes[i]);
    }
  }
  FinishedTrials taken;
  int calls{0};

 private:
  std::function<void()> on_take_;
};

TEST(Sink, TakesEveryTrialThatRanOnceInOrder) {
  for (const unsigned threads : {1U, 3U}) {
    const Study study = resumable(3000);
    NotingSink sink;
    RunOptions options;
    options.threads = threads;
    options.sink = &sink;
    const StudyResult whole = run_study(study, options);
    EXPECT_EQ(sink.taken.trials.index, whole.trials.index);
    EXPECT_EQ(sink.taken.trials.outcomes, whole.trials.outcomes);

    NotingSink rest;
    options.sink = &rest;
    const auto known = [](std::uint64_t index) { return index < 100 || (index > 500 && index < 900); };
    run_study(study, options, part_of(whole, known));
    const FinishedTrials ran = part_of(whole, [&](std::uint64_t index) { return !known(index); });
    EXPECT_EQ(rest.taken.trials.index, ran.trials.index);
    EXPECT_EQ(rest.taken.trials.outcomes, ran.trials.outcomes);
  }
}

/// Runs an engine's trials one at a time, each no sooner than after a pause.
class SlowRunner final : public TrialRunner {
 public:
  explicit SlowRunner(std::chrono::milliseconds pause) : pause_(pause) {}
  using TrialRunner::run;
  void run(TrialStream& stream) override {
    std::uint64_t index = 0;
    TrialParameters parameters;
    while (stream.next(index, parameters)) {
      std::this_thread::sleep_for(pause_);
      TrialOutcome outcome;
      outcome.end_time = static_cast<double>(index);
      stream.finished(index, outcome);
    }
  }

 private:
  std::chrono::milliseconds pause_;
};

/// Runs trials in no time, but waits after the first block until somebody has seen it.
class WatchedRunner final : public TrialRunner {
 public:
  explicit WatchedRunner(const std::atomic<bool>& seen) : seen_(seen) {}
  using TrialRunner::run;
  void run(TrialStream& stream) override {
    std::uint64_t index = 0;
    TrialParameters parameters;
    for (std::uint64_t count = 0; stream.next(index, parameters); ++count) {
      while (count == 16 && !seen_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      stream.finished(index, {});
    }
  }

 private:
  const std::atomic<bool>& seen_;
};

TEST(Sink, TakesTrialsWhileTheRunGoesOnButNotEachBlockByItself) {
  Study study = resumable(320, "cvode", R"(, "name": "slow")");
  study.audited_trials = 0;
  study.retention = {};
  std::atomic<bool> seen{false};
  NotingSink sink([&] { seen = true; });
  RunOptions options;
  options.threads = 1;
  options.sink = &sink;
  options.make_runner = [&](const IntegratorChoice&) { return std::make_unique<WatchedRunner>(seen); };
  run_study(study, options);  // 20 blocks; for ever, if the sink got nothing before the end
  EXPECT_EQ(sink.taken.trials.index.size(), 320U);
  EXPECT_GE(sink.calls, 2);
  EXPECT_LT(sink.calls, 20);
}

struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

TEST(Sink, WhatItThrowsEndsTheRun) {
  Study study = resumable(1000000, "cvode");
  study.audited_trials = 0;
  std::atomic<int> taken{0};
  NotingSink sink([&] {
    if (++taken == 2) throw Broken("no room");
  });
  RunOptions options;
  options.threads = 2;
  options.sink = &sink;
  options.make_runner = [](const IntegratorChoice&) {
    return std::make_unique<SlowRunner>(std::chrono::milliseconds(1));
  };
  EXPECT_THROW(run_study(study, options), Broken);
  EXPECT_EQ(taken, 2) << "a sink that failed is not called again";
}

TEST(Sink, WhatItThrowsAtTheEndIsNotLost) {
  NotingSink sink([] { throw Broken("no room"); });
  RunOptions options;
  options.sink = &sink;
  EXPECT_THROW(run_study(resumable(200), options), Broken);
}

TEST(Sink, GetsWhatAStoppedRunHadFinished) {
  const Study study = resumable(1000000, "cvode", R"(, "name": "stopped")");
  std::stop_source stop;
  NotingSink sink([&] { stop.request_stop(); });
  RunOptions options;
  options.threads = 2;
  options.sink = &sink;
  options.stop = stop.get_token();
  options.make_runner = [](const IntegratorChoice&) {
    return std::make_unique<SlowRunner>(std::chrono::milliseconds(1));
  };
  Study plain = study;
  plain.audited_trials = 0;
  plain.retention = {};
  const StudyResult stopped = run_study(plain, options);
  EXPECT_FALSE(stopped.complete);
  EXPECT_EQ(sink.taken.trials.index, stopped.trials.index);
}

}  // namespace
}  // namespace steerstat
