#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>

#include "core/errors.hpp"
#include "study/continuation.hpp"
#include "study/run.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

Study resumable(std::uint64_t trials, const std::string& method = "lockstep", const std::string& more = "") {
  return decode_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}}, "horizon": 20,
      "retain": {"trajectories": {"first": 1, "failed": 2}}, "audit": {"trials": 2}, "integrator": {"method": ")" +
                          method + R"("}, "sampling": {"trials": )" + std::to_string(trials) + "}" + more + "}",
                      {});
}

void expect_same(const StudyResult& a, const StudyResult& b) {
  EXPECT_EQ(a.complete, b.complete);
  EXPECT_EQ(a.threads, b.threads);
  EXPECT_EQ(a.simd, b.simd);
  ASSERT_EQ(a.trials.index, b.trials.index);
  for (std::size_t row = 0; row < a.trials.index.size(); ++row) {
    ASSERT_TRUE(same_bits(a.trials.outcomes[row], b.trials.outcomes[row])) << "row " << row;
  }
  ASSERT_EQ(a.audit.trials.size(), b.audit.trials.size());
  for (std::size_t i = 0; i < a.audit.trials.size(); ++i) {
    EXPECT_EQ(a.audit.trials[i].index, b.audit.trials[i].index);
  }
  ASSERT_EQ(a.trajectories.size(), b.trajectories.size());
  for (std::size_t i = 0; i < a.trajectories.size(); ++i) EXPECT_EQ(a.trajectories[i].index, b.trajectories[i].index);
}

/// The rows of `whole` whose indices pass.
template <class Passes>
FinishedTrials part_of(const StudyResult& whole, const Passes& passes) {
  FinishedTrials part;
  for (std::size_t row = 0; row < whole.trials.index.size(); ++row) {
    if (!passes(whole.trials.index[row])) continue;
    part.trials.index.push_back(whole.trials.index[row]);
    part.trials.outcomes.push_back(whole.trials.outcomes[row]);
  }
  return part;
}

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

class ResumedRun : public testing::TestWithParam<const char*> {};

TEST_P(ResumedRun, IsTheSameAsAnUninterruptedOneWhateverWasFinishedEarlier) {
  const bool lockstep = std::string(GetParam()) == "lockstep";
  const std::uint64_t trials = lockstep ? 700 : 50;
  const Study study = resumable(trials, GetParam());
  RunOptions options;
  options.threads = 2;
  const StudyResult whole = run_study(study, options);
  std::mt19937_64 generator(11);
  const auto random = [&](std::uint64_t) { return generator() % 3 == 0; };
  const std::vector<std::function<bool(std::uint64_t)>> parts{
      [](std::uint64_t) { return false; },
      [](std::uint64_t) { return true; },
      [&](std::uint64_t i) { return i < trials / 2; },
      [&](std::uint64_t i) { return i >= trials / 2; },
      [&](std::uint64_t i) { return i % block_size(study) == 0; },
      [&](std::uint64_t i) { return i / block_size(study) % 2 == 1; },
      random,
  };
  for (const auto& part : parts) {
    for (const unsigned threads : {1U, 2U}) {
      options.threads = threads;
      StudyResult resumed = run_study(study, options, part_of(whole, part));
      EXPECT_EQ(resumed.threads, threads);
      resumed.threads = whole.threads;
      expect_same(resumed, whole);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, ResumedRun, testing::Values("lockstep", "cvode"),
                         [](const auto& one) { return std::string(one.param); });

/// Counts the trials that an engine runs.
class CountingRunner final : public TrialRunner {
 public:
  CountingRunner(std::unique_ptr<TrialRunner> engine, std::vector<int>& counts)
      : engine_(std::move(engine)), counts_(counts) {}
  using TrialRunner::run;
  void run(TrialStream& stream) override {
    struct Counting final : TrialStream {
      Counting(TrialStream& counted, std::vector<int>& of_trials) : stream(counted), counts(of_trials) {}
      bool next(std::uint64_t& index, TrialParameters& parameters) override {
        if (!stream.next(index, parameters)) return false;
        ++counts[index];
        return true;
      }
      void finished(std::uint64_t index, const TrialOutcome& outcome) override { stream.finished(index, outcome); }
      TrialStream& stream;
      std::vector<int>& counts;
    };
    Counting counting(stream, counts_);
    engine_->run(counting);
  }

 private:
  std::unique_ptr<TrialRunner> engine_;
  std::vector<int>& counts_;
};

TEST(ResumedRunOf, AnEarlierRunsTrialsRunsNoneOfThemAgain) {
  const Study study = resumable(700);
  const StudyResult whole = run_study(study, {});
  std::vector<int> counts(700);
  RunOptions options;
  options.threads = 1;
  options.make_runner = [&](const IntegratorChoice& choice) {
    return std::make_unique<CountingRunner>(make_runner(choice), counts);
  };
  const auto known = [](std::uint64_t index) { return index < 300 || (index >= 333 && index < 450); };
  run_study(study, options, part_of(whole, known));
  for (std::uint64_t i = 0; i < 700; ++i) EXPECT_EQ(counts[i], known(i) ? 0 : 1) << "trial " << i;
}

TEST(ResumedRunOf, AShorterStudyExtendsIt) {
  const char* const swept = R"(, "controller": {"contraction": {"eta1": {"sweep": [0.3, 0.5, 0.7]}}})";
  for (const std::string more : {"", swept}) {
    const Study shorter = resumable(70, "lockstep", more);
    const Study longer = resumable(300, "lockstep", more);
    ASSERT_TRUE(continues(longer, shorter));
    StudyResult earlier = run_study(shorter, {});
    const StudyResult extended = run_study(longer, {}, {std::move(earlier.trials), earlier.wall_s});
    expect_same(extended, run_study(longer, {}));
  }
}

TEST(ResumedRunOf, AStudyThatStopsOnPrecisionStopsAtTheSameTrialWhateverWasFinishedEarlier) {
  Study study = resumable(3000, "lockstep", R"(, "stop": {"min_trials": 300, "check_every": 100,
      "until": [{"metric": "timeout_rate", "half_width": 0.06}]})");
  study.horizon = 60.0;
  const StudyResult whole = run_study(study, {});
  const std::uint64_t rows = whole.trials.index.size();
  ASSERT_TRUE(whole.complete);
  ASSERT_GT(rows, 300U);
  ASSERT_LT(rows, 2000U) << "the study is meant to stop early";
  Study endless = study;  // for trials beyond the look, as an interrupted run may have kept
  endless.stop.reset();
  endless.intervals = {};
  const StudyResult all = run_study(endless, {});
  for (const std::uint64_t known : {std::uint64_t{0}, rows / 2, rows - 1, rows, rows + 1, rows + 500}) {
    expect_same(run_study(study, {}, part_of(all, [&](std::uint64_t index) { return index < known; })), whole);
    expect_same(run_study(study, {}, part_of(all, [&](std::uint64_t index) { return index >= known; })), whole);
  }
}

TEST(ResumedRunOf, MoreThanTheStudyHasIsRefused) {
  StudyResult longer = run_study(resumable(300), {});
  EXPECT_THROW(run_study(resumable(200), {}, {std::move(longer.trials), 0.0}), std::invalid_argument);
}

TEST(ResumedRunOf, AStoppedOneKeepsWhatWasKnownBeyondAGap) {
  const Study study = resumable(1000);
  const StudyResult whole = run_study(study, {});
  std::stop_source stop;
  stop.request_stop();
  RunOptions options;
  options.stop = stop.get_token();
  const auto known = [](std::uint64_t index) { return index < 130 || index >= 900; };
  const StudyResult stopped = run_study(study, options, part_of(whole, known));
  EXPECT_FALSE(stopped.complete);
  ASSERT_EQ(stopped.trials.index.size(), 230U);
  for (std::size_t row = 0; row < 230; ++row) {
    const std::uint64_t index = row < 130 ? row : row + 770;
    EXPECT_EQ(stopped.trials.index[row], index);
    EXPECT_TRUE(same_bits(stopped.trials.outcomes[row], whole.trials.outcomes[index]));
  }
}

TEST(ResumedRunOf, AnEarlierRunsTrialsTakesTheirTimeAndCountsThemAsProgress) {
  const Study study = resumable(300);
  const StudyResult whole = run_study(study, {});
  FinishedTrials earlier = part_of(whole, [](std::uint64_t index) { return index < 200; });
  earlier.wall_s = 1000.0;
  RunOptions options;
  std::vector<Progress> seen;
  options.on_progress = [&](const Progress& progress) { seen.push_back(progress); };
  EXPECT_GT(run_study(study, options, std::move(earlier)).wall_s, 1000.0);
  ASSERT_GE(seen.size(), 1U);
  EXPECT_GE(seen.front().completed, 200U);
  EXPECT_EQ(seen.back().completed, 300U);
  EXPECT_EQ(seen.back().earlier, 200U);
  EXPECT_LT(seen.back().elapsed, 1000.0);
}

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

TEST(Continuation, IsTheSameStudyWithAsManyDrawsOrMore) {
  const Study study = resumable(100);
  EXPECT_TRUE(continues(study, study));
  EXPECT_TRUE(continues(resumable(101), study));
  EXPECT_FALSE(continues(resumable(99), study));
  EXPECT_EQ(trials_sha256(resumable(101)), trials_sha256(study));
  EXPECT_NE(spec_sha256(resumable(101)), spec_sha256(study));
}

TEST(Continuation, IsNoStudyThatDiffersInAnythingElse) {
  const Study study = resumable(100);
  Study other = study;
  other.sampling.seed = 2;
  EXPECT_FALSE(continues(other, study));
  EXPECT_NE(trials_sha256(other), trials_sha256(study));
  EXPECT_FALSE(continues(resumable(100, "cvode"), study));
  EXPECT_FALSE(continues(resumable(200, "lockstep", R"(, "name": "other")"), study));
}

TEST(Continuation, DependsOnWhetherMoreDrawsKeepTheFirstOnes) {
  for (const SamplingMethod method :
       {SamplingMethod::monte_carlo, SamplingMethod::sobol, SamplingMethod::sobol_indices}) {
    Study study = resumable(100);
    study.sampling.method = method;
    Study longer = study;
    longer.sampling.trials = 200;
    EXPECT_TRUE(continues(longer, study));
    const Plan plan(study);
    const Plan longer_plan(longer);
    std::vector<double> drawn(plan.varying().size());
    std::vector<double> drawn_longer(drawn.size());
    for (std::uint64_t i = 0; i < 100; ++i) {
      plan.draw(i, drawn);
      longer_plan.draw(i, drawn_longer);
      EXPECT_EQ(drawn, drawn_longer);
    }
  }
  Study hypercube = resumable(100);
  hypercube.sampling.method = SamplingMethod::latin_hypercube;
  Study longer = hypercube;
  longer.sampling.trials = 200;
  EXPECT_FALSE(continues(longer, hypercube));
  EXPECT_TRUE(continues(hypercube, hypercube));
}

}  // namespace
}  // namespace steerstat
