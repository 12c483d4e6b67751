#include "distributed/range_dealer.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace steerstat {
namespace {

/// Deals until nothing is left.
std::vector<TrialRange> all_of(RangeDealer& dealer, unsigned threads, double rate) {
  std::vector<TrialRange> ranges;
  while (const auto range = dealer.deal(threads, rate)) ranges.push_back(*range);
  return ranges;
}

TEST(RangeDealer, DealsEveryTrialOnceInOrderAndInWholeBlocks) {
  for (const std::uint64_t trials : {1U, 128U, 129U, 100000U}) {
    RangeDealer dealer({}, trials, 128, 3);
    EXPECT_EQ(dealer.left(), trials);
    std::uint64_t end = 0;
    for (const TrialRange& range : all_of(dealer, 2, 1e4)) {
      EXPECT_EQ(range.begin, end);
      EXPECT_GT(range.end, range.begin);
      EXPECT_EQ(range.begin % 128, 0U);
      end = range.end;
    }
    EXPECT_EQ(end, trials);
    EXPECT_EQ(dealer.left(), 0U);
  }
}

TEST(RangeDealer, DealsWholeBlocksOfWhatIsMissing) {
  const std::vector<TrialRange> known{{0, 100}, {256, 512}, {600, 610}, {620, 1000}};
  RangeDealer dealer(known, 1000, 128, 1);
  const std::vector<TrialRange> expected{{0, 128}, {128, 256}, {512, 640}};
  EXPECT_EQ(all_of(dealer, 1, 0.0), expected);
}

TEST(RangeDealer, ARangeTakesARankAboutTwoSecondsAndLessTowardsTheEnd) {
  RangeDealer dealer({}, 1000000, 128, 4);
  const TrialRange first = *dealer.deal(2, 10000.0);
  EXPECT_NEAR(static_cast<double>(first.end - first.begin), 20000.0, 128.0);
  const std::vector<TrialRange> rest = all_of(dealer, 2, 10000.0);
  EXPECT_LE(rest.back().end - rest.back().begin, 2U * 128U) << "one block a thread";
  EXPECT_TRUE(std::is_sorted(rest.rbegin(), rest.rend() - 1, [](TrialRange a, TrialRange b) {
    return a.end - a.begin < b.end - b.begin;
  })) << "they never grow";
}

TEST(RangeDealer, ARangeIsAsLongAsAskedForButHasNoMoreTrialsThanItMay) {
  RangeDealer dealer({}, std::uint64_t{1} << 40, 128, 1, {20.0, std::uint64_t{1} << 18});
  const auto trials_at = [&](double rate) {
    const TrialRange range = *dealer.deal(4, rate);
    return range.end - range.begin;
  };
  EXPECT_EQ(trials_at(128.0), 20U * 128U);
  EXPECT_EQ(trials_at(13107.1), (std::uint64_t{1} << 18) - 128U);
  EXPECT_EQ(trials_at(13107.2), std::uint64_t{1} << 18);
  EXPECT_EQ(trials_at(1e15), std::uint64_t{1} << 18);
}

TEST(RangeDealer, DealsNothingAfterAHalt) {
  RangeDealer dealer({}, 1000, 128, 1);
  ASSERT_TRUE(dealer.deal(1, 0.0));
  dealer.halt();
  EXPECT_FALSE(dealer.deal(1, 0.0));
  EXPECT_EQ(dealer.left(), 0U);
}

}  // namespace
}  // namespace steerstat
