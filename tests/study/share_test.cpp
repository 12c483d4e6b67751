#include "study/share.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <utility>

#include "study/run.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

Study shared_study(std::uint64_t trials, const std::string& more = "") {
  return decode_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}}, "horizon": 5,
      "retain": {"trajectories": {"first": 1}}, "sampling": {"trials": )" +
                          std::to_string(trials) + "}" + more + "}",
                      {});
}

TEST(StudyShare, IsReadOnlyWhereItIsOneOfItsShards) {
  EXPECT_EQ(parse_share("1/1"), (StudyShare{1, 1}));
  EXPECT_EQ(parse_share("3/10"), (StudyShare{3, 10}));
  EXPECT_EQ(parse_share("10/10"), (StudyShare{10, 10}));
  EXPECT_EQ(parse_share("1/1000000"), (StudyShare{1, 1000000}));
  for (const char* text : {"0/4", "5/4", "1/0", "0/0", "1/1000001", "", "/", "1", "1/", "/4", "1/4/2", "-1/4", "+1/4",
                           " 1/4", "1/4 ", "1.0/4", "a/b", "4294967297/4294967298"}) {
    EXPECT_FALSE(parse_share(text)) << text;
  }
}

TEST(StudyShare, SharesAreEveryTrialOnceInWholeBlocksAndAlike) {
  for (const std::uint64_t trials : {1U, 127U, 128U, 129U, 1280U, 1281U, 10000U}) {
    for (const std::uint32_t count : {1U, 2U, 3U, 7U, 100U}) {
      std::uint64_t end = 0;
      for (std::uint32_t number = 1; number <= count; ++number) {
        const TrialRange range = share_of(trials, 128, {number, count});
        EXPECT_EQ(range.begin, end);
        EXPECT_TRUE(range.begin % 128 == 0 || range.begin == trials);
        const std::uint64_t blocks = (range.end - range.begin + 127) / 128;
        const std::uint64_t all = (trials + 127) / 128;
        EXPECT_GE(blocks, all / count);
        EXPECT_LE(blocks, all / count + 1);
        end = range.end;
      }
      EXPECT_EQ(end, trials) << count << " shards of " << trials;
    }
  }
}

TEST(StudyShare, TheLargestNumbersDoNotOverflow) {
  const std::uint64_t trials = std::uint64_t{1} << 62;
  EXPECT_EQ(share_of(trials, 1, {most_shares, most_shares}).end, trials);
  EXPECT_EQ(share_of(trials, 1, {1, 2}).end, trials / 2);
}

TEST(RunRange, GivesTheTrialsOfTheWholeStudyBitByBit) {
  const Study study = shared_study(1000);
  RunOptions options;
  options.threads = 2;
  const StudyResult whole = run_study(study, options);
  const StudyResult part = run_range(study, {256, 700}, options);
  EXPECT_FALSE(part.complete);
  EXPECT_TRUE(part.audit.trials.empty());
  EXPECT_TRUE(part.trajectories.empty());
  ASSERT_EQ(part.trials.index.size(), 444U);
  for (std::size_t row = 0; row < 444; ++row) {
    ASSERT_EQ(part.trials.index[row], 256 + row);
    ASSERT_TRUE(same_bits(part.trials.outcomes[row], whole.trials.outcomes[256 + row])) << "row " << row;
  }
}

TEST(RunRange, HandsOverEachOfItsTrialsOnceByTheStudysIndices) {
  class Sink final : public OutcomeSink {
   public:
    void take(std::uint64_t begin, std::span<const TrialOutcome> outcomes) override {
      EXPECT_EQ(begin, next);
      next = begin + outcomes.size();
    }
    std::uint64_t next{128};
  } sink;
  RunOptions options;
  options.sink = &sink;
  run_range(shared_study(1000), {128, 900}, options);
  EXPECT_EQ(sink.next, 900U);
}

TEST(RunRange, TakesOfEarlierTrialsThoseOfTheRange) {
  const Study study = shared_study(1000);
  const StudyResult whole = run_range(study, {0, 1000}, {});
  FinishedTrials earlier;
  for (const std::uint64_t index : {5U, 300U, 301U, 999U}) {
    earlier.trials.index.push_back(index);
    earlier.trials.outcomes.push_back(whole.trials.outcomes[index]);
  }
  Progress last;
  RunOptions options;
  options.on_progress = [&last](const Progress& progress) { last = progress; };
  const StudyResult part = run_range(study, {256, 512}, options, std::move(earlier));
  EXPECT_EQ(last.requested, 256U);
  EXPECT_EQ(last.earlier, 2U);
  ASSERT_EQ(part.trials.index.size(), 256U);
  for (std::size_t row = 0; row < 256; ++row) {
    ASSERT_TRUE(same_bits(part.trials.outcomes[row], whole.trials.outcomes[256 + row])) << "row " << row;
  }
}

TEST(RunRange, HeedsNoStopRule) {
  const Study study = shared_study(
      2000,
      R"(, "stop": {"min_trials": 10, "check_every": 10, "until": [{"metric": "success_rate", "half_width": 0.4}]})");
  EXPECT_EQ(run_range(study, {128, 1500}, {}).trials.index.size(), 1372U);
}

TEST(RunRange, RefusesWhatIsNoRangeOfBlocks) {
  const Study study = shared_study(1000);
  EXPECT_THROW(run_range(study, {1, 1000}, {}), std::invalid_argument);
  EXPECT_THROW(run_range(study, {0, 1001}, {}), std::invalid_argument);
  EXPECT_THROW(run_range(study, {256, 128}, {}), std::invalid_argument);
  EXPECT_TRUE(run_range(study, {256, 256}, {}).trials.index.empty());
}

}  // namespace
}  // namespace steerstat
