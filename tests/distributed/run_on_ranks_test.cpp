#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "../nightly.hpp"
#include "core/errors.hpp"
#include "distributed/job.hpp"
#include "distributed/lead.hpp"
#include "study/spec_json.hpp"
#include "thread_ranks.hpp"

namespace steerstat {
namespace {

namespace fs = std::filesystem;
using steerstat::testing::is_sanitized;
using ::testing::HasSubstr;

Study study_of(std::uint64_t trials, const std::string& more = "") {
  return decode_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}}, "horizon": 5,
      "retain": {"trajectories": {"first": 1}}, "audit": {"trials": 1}, "sampling": {"trials": )" +
                          std::to_string(trials) + "}" + more + "}",
                      {});
}

class RunOnRanks : public ::testing::Test {
 protected:
  ~RunOnRanks() override { fs::remove_all(path_); }

  /// Runs what is missing on ranks that are threads. @param stops  of the other ranks, by rank less 1
  RankedRun run(int ranks, const Study& study, FinishedTrials earlier = {}, StudyDirectory* directory = nullptr,
                bool gather = true, const std::vector<std::stop_token>& stops = {}) {
    testing::Mailboxes boxes(ranks);
    testing::ThreadRanks leader(boxes, 0);
    std::vector<std::jthread> others;
    for (int rank = 1; rank < ranks; ++rank) {
      WorkOptions options;
      options.threads = 1;
      if (!stops.empty()) options.stop = stops[static_cast<std::size_t>(rank) - 1];
      others.emplace_back([&boxes, rank, options] {
        testing::ThreadRanks self(boxes, rank);
        EXPECT_EQ(work(self, options), 7);
      });
    }
    struct End {
      ~End() { end_ranks(ranks, 7); }
      Ranks& ranks;
    } const end{leader};
    RunOptions options;
    options.threads = 1;
    return run_on_ranks(leader, study, options, std::move(earlier), directory, {gather, seconds_a_range_});
  }

  static void expect_same(const StudyResult& a, const StudyResult& b) {
    EXPECT_EQ(a.complete, b.complete);
    EXPECT_EQ(a.trials.index, b.trials.index);
    EXPECT_TRUE(a.trials.outcomes == b.trials.outcomes);
    EXPECT_EQ(a.trajectories.size(), b.trajectories.size());
    EXPECT_EQ(a.audit.trials.size(), b.audit.trials.size());
  }

  std::optional<double> seconds_a_range_{};
  fs::path path_ = fs::path(::testing::TempDir()) / ("ranks-" + std::to_string(getpid()) + ".parts");
};

TEST_F(RunOnRanks, GivesTheBitsOfOneProcessOnOneTwoAndFourRanks) {
  const Study study = study_of(3000);
  const StudyResult alone = run_study(study, {});
  for (const int ranks : {1, 2, 4}) {
    RankedRun together = run(ranks, study);
    EXPECT_EQ(together.threads, static_cast<unsigned>(ranks));
    EXPECT_EQ(together.finished.trials.index.size(), 3000U);
    expect_same(completed(study, {}, std::move(together)), alone);
  }
}

TEST_F(RunOnRanks, KeepsEveryTrialInTheDirectoryWhoeverWritesIt) {
  const Study study = study_of(1500);
  const StudyResult alone = run_study(study, {});
  for (const bool gather : {false, true}) {
    StudyDirectory directory(path_);
    directory.begin(study);
    RankedRun together = run(2, study, {}, &directory, gather);
    EXPECT_EQ(directory.recover().finished.trials.index.size(), 1500U);
    EXPECT_TRUE(together.set_aside.empty());
    expect_same(completed(study, {}, std::move(together)), alone);
    directory.remove();
  }
}

TEST_F(RunOnRanks, OfAStudyThatKeepsNoRowsGivesTheSketchOfOneProcess) {
  const Study study = study_of(4000, R"(, "store": "summary")");
  const StudyResult alone = run_study(study, {});
  ASSERT_TRUE(alone.sketch);
  const auto expect_sketch = [&](RankedRun together) {
    const StudyResult result = completed(study, {}, std::move(together));
    EXPECT_TRUE(result.sketch == alone.sketch);
    expect_same(result, alone);
  };
  for (const int ranks : {1, 2, 4}) expect_sketch(run(ranks, study));
  for (const bool gather : {false, true}) {
    StudyDirectory directory(path_);
    directory.begin(study);
    const FinishedTrials begun{{}, 0.0, run_range(study, {100, 1100}, {}).sketch};
    expect_sketch(run(2, study, begun, &directory, gather));
    EXPECT_EQ(directory.recover().finished.count(), 3000U);
    directory.remove();
  }
}

TEST_F(RunOnRanks, GivesTheSameBitsHoweverMuchARankIsGivenAtATime) {
  for (const char* store : {"all", "summary"}) {
    const Study study = study_of(is_sanitized ? 300 : 1000, std::string(R"(, "store": ")") + store + "\"");
    const StudyResult alone = run_study(study, {});
    for (const double seconds : {0.001, 3600.0}) {
      seconds_a_range_ = seconds;
      const StudyResult together = completed(study, {}, run(2, study));
      EXPECT_TRUE(together.sketch == alone.sketch);
      expect_same(together, alone);
    }
  }
}

TEST(SecondsARange, AreTwoUnlessRanksWouldAskMoreThanFiftyTimesASecond) {
  EXPECT_EQ(usual_seconds_a_range(1), 2.0);
  EXPECT_EQ(usual_seconds_a_range(100), 2.0);
  EXPECT_EQ(usual_seconds_a_range(101), 2.02);
  EXPECT_EQ(usual_seconds_a_range(1000), 20.0);
}

TEST_F(RunOnRanks, RunsOnlyWhatIsMissing) {
  const Study study = study_of(1500);
  const StudyResult alone = run_study(study, {});
  FinishedTrials earlier;
  for (std::uint64_t index = 0; index < 1500; ++index) {
    if (index >= 200 && index < 900) continue;
    earlier.trials.index.push_back(index);
    earlier.trials.outcomes.push_back(alone.trials.outcomes[index]);
  }
  StudyDirectory directory(path_);
  directory.begin(study);
  RankedRun together = run(2, study, earlier, &directory, false);
  const std::uint64_t written = directory.recover().finished.trials.index.size();
  EXPECT_EQ(written, 896U) << "the blocks from trial 128 to 1024";
  expect_same(completed(study, {}, std::move(together)), alone);
}

TEST_F(RunOnRanks, StopsWhereOneProcessWouldHave) {
  const Study study = study_of(20000, R"(, "stop": {"min_trials": 500, "check_every": 100,
                                          "until": [{"metric": "timeout_rate", "half_width": 0.05}]})");
  const StudyResult alone = run_study(study, {});
  ASSERT_LT(alone.trials.index.size(), 5000U);
  RankedRun together = run(3, study);
  EXPECT_LT(together.finished.trials.index.size(), 20000U) << "nobody runs to the end";
  expect_same(completed(study, {}, std::move(together)), alone);
}

TEST_F(RunOnRanks, ARankThatIsInterruptedEndsTheRunWithWhatIsFinishedKept) {
  const Study study = study_of(200000);
  std::stop_source interrupted;
  interrupted.request_stop();
  StudyDirectory directory(path_);
  directory.begin(study);
  const RankedRun together = run(2, study, {}, &directory, false, {interrupted.get_token()});
  EXPECT_LT(together.finished.trials.index.size(), 200000U);
  EXPECT_EQ(together.finished.trials.index.size() % 128, 0U);
}

TEST_F(RunOnRanks, ARankThatFailsSaysWhyAndNobodyWorksOn) {
  const Study study = study_of(200000);
  StudyDirectory directory(path_);
  directory.begin(study);
  fs::remove(path_ / "study.h5");  // as where the file system is not shared
  try {
    run(2, study, {}, &directory, false);
    FAIL() << "no failure";
  } catch (const RunFailure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("does not see the study in"));
    EXPECT_THAT(failure.what(), HasSubstr("--gather"));
  }
  EXPECT_FALSE(directory.has_shards());
}

}  // namespace
}  // namespace steerstat
