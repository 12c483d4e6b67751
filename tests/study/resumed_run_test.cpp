#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "resumable_study.hpp"
#include "study/continuation.hpp"

namespace steerstat {
namespace {

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

class ResumedRun : public ::testing::TestWithParam<const char*> {};

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

INSTANTIATE_TEST_SUITE_P(Engines, ResumedRun, ::testing::Values("lockstep", "cvode"),
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

}  // namespace
}  // namespace steerstat
