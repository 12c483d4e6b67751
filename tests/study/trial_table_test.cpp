#include "study/trial_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace steerstat {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// An outcome that tells its trial, and which of two runs it is of.
TrialOutcome outcome_of(std::uint64_t index, double run = 0.0) {
  TrialOutcome outcome;
  outcome.end_time = static_cast<double>(index) + 1.0;
  outcome.end_state.q1 = run;
  return outcome;
}

FinishedTrials finished(const std::vector<std::uint64_t>& index, double wall_s, double run = 0.0) {
  FinishedTrials trials;
  trials.wall_s = wall_s;
  for (const std::uint64_t i : index) {
    trials.trials.index.push_back(i);
    trials.trials.outcomes.push_back(outcome_of(i, run));
  }
  return trials;
}

void expect_rows(const TrialTable& table, const std::vector<std::uint64_t>& index) {
  EXPECT_EQ(table.index, index);
  ASSERT_EQ(table.outcomes.size(), index.size());
  for (std::size_t row = 0; row < index.size(); ++row) {
    EXPECT_EQ(table.outcomes[row].end_time, static_cast<double>(index[row]) + 1.0);
  }
}

TEST(TrialRanges, AreTheRunsOfConsecutiveTrials) {
  EXPECT_THAT(ranges_of({}), IsEmpty());
  const std::vector<std::uint64_t> index{0, 1, 2, 5, 7, 8};
  EXPECT_THAT(ranges_of(index), ElementsAre(TrialRange{0, 3}, TrialRange{5, 6}, TrialRange{7, 9}));
  EXPECT_EQ(trials_in(ranges_of(index)), 6U);
}

TEST(MissingBlocks, AreAllBlocksWhereNothingIsKnown) {
  EXPECT_THAT(missing_blocks({}, 10, 4), ElementsAre(TrialRange{0, 4}, TrialRange{4, 8}, TrialRange{8, 10}));
  EXPECT_THAT(missing_blocks({}, 8, 4), ElementsAre(TrialRange{0, 4}, TrialRange{4, 8}));
  EXPECT_THAT(missing_blocks({}, 0, 4), IsEmpty());
}

TEST(MissingBlocks, LeaveOutExactlyWhatIsKnown) {
  const std::vector<TrialRange> known{{0, 3}, {5, 6}, {7, 9}};
  EXPECT_THAT(missing_blocks(known, 20, 4), ElementsAre(TrialRange{3, 4}, TrialRange{4, 5}, TrialRange{6, 7},
                                                        TrialRange{9, 12}, TrialRange{12, 16}, TrialRange{16, 20}));
  EXPECT_THAT(missing_blocks(std::vector<TrialRange>{{0, 20}}, 20, 4), IsEmpty());
  EXPECT_THAT(missing_blocks(std::vector<TrialRange>{{4, 8}}, 9, 4), ElementsAre(TrialRange{0, 4}, TrialRange{8, 9}));
}

TEST(JoinedTrials, AreThoseOfEitherOnceEach) {
  expect_rows(joined({}, {}).trials, {});
  expect_rows(joined(finished({1, 2}, 1), {}).trials, {1, 2});
  expect_rows(joined({}, finished({1, 2}, 1)).trials, {1, 2});
  expect_rows(joined(finished({0, 1}, 1), finished({2, 9}, 1)).trials, {0, 1, 2, 9});
  expect_rows(joined(finished({2, 9}, 1), finished({0, 1}, 1)).trials, {0, 1, 2, 9});
  const FinishedTrials both = joined(finished({0, 2, 3, 8}, 1, 1.0), finished({1, 2, 8, 9}, 1, 2.0));
  expect_rows(both.trials, {0, 1, 2, 3, 8, 9});
  EXPECT_EQ(both.trials.outcomes[2].end_state.q1, 1.0) << "of a trial in both, the first is taken";
  EXPECT_EQ(both.trials.outcomes[5].end_state.q1, 2.0);
}

TEST(JoinedTrials, TookTheTimeOfBothUnlessOneIsMadeOfTheOther) {
  EXPECT_EQ(joined(finished({0, 1}, 2), finished({2}, 3)).wall_s, 5.0);
  EXPECT_EQ(joined(finished({0, 2}, 2), finished({1, 2}, 3)).wall_s, 5.0);
  EXPECT_EQ(joined(finished({0, 1, 2}, 4), finished({0, 1}, 3)).wall_s, 4.0);
  EXPECT_EQ(joined(finished({0, 1}, 3), finished({0, 1, 2}, 4)).wall_s, 4.0);
}

TEST(Slots, HoldEachOutcomeAtItsIndexAndGiveItBack) {
  for (const std::vector<std::uint64_t>& index :
       {std::vector<std::uint64_t>{}, {0, 1, 2}, {3, 4, 9}, {0, 1, 4, 5, 6, 9}, {9}}) {
    std::vector<TrialOutcome> slots = spread(finished(index, 0).trials, 10);
    ASSERT_EQ(slots.size(), 10U);
    const std::vector<TrialRange> known = ranges_of(index);
    for (std::uint64_t i = 0; i < 10; ++i) {
      const bool is_known = std::find(index.begin(), index.end(), i) != index.end();
      EXPECT_TRUE(slots[i] == (is_known ? outcome_of(i) : TrialOutcome{})) << "trial " << i;
    }
    expect_rows(gathered(std::move(slots), 0, known), index);
  }
}

TEST(Slots, AreGatheredUpToAnEndAndBeyondItWhereKnown) {
  std::vector<TrialOutcome> slots;
  for (std::uint64_t i = 0; i < 10; ++i) slots.push_back(outcome_of(i));
  expect_rows(gathered(slots, 4, std::vector<TrialRange>{{0, 2}, {3, 6}, {8, 9}}), {0, 1, 2, 3, 4, 5, 8});
  expect_rows(gathered(slots, 10, std::vector<TrialRange>{{3, 6}}), {0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
}

TEST(Slots, RefuseATrialBeyondTheLast) {
  EXPECT_NO_THROW(spread(finished({9}, 0).trials, 10));
  EXPECT_THROW(spread(finished({10}, 0).trials, 10), std::invalid_argument);
}

}  // namespace
}  // namespace steerstat
