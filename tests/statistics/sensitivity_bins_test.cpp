#include "statistics/sensitivity_bins.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

namespace steerstat {
namespace {

using ::testing::ElementsAre;

std::vector<BinEntry> entries_at(const std::vector<double>& x) {
  std::vector<std::uint64_t> unit(x.size());
  std::iota(unit.begin(), unit.end(), 0U);
  return sorted_entries(x, x, unit);
}

std::vector<double> rising(std::size_t n) {
  std::vector<double> x(n);
  std::iota(x.begin(), x.end(), 0.0);
  return x;
}

TEST(SortedEntries, RiseByValueAndMakeOneOfAUnitsTrials) {
  const std::vector<double> x{2, 1, 2, 1};
  const std::vector<double> y{5, 6, 7, 8};
  const std::vector<std::uint64_t> unit{9, 4, 9, 3};
  const std::vector<BinEntry> entries = sorted_entries(x, y, unit);
  ASSERT_EQ(entries.size(), 3U);
  EXPECT_EQ(entries[0].unit, 3U);
  EXPECT_EQ(entries[1].unit, 4U);
  EXPECT_EQ(entries[2].unit, 9U);
  EXPECT_EQ(entries[2].count, 2.0);
  EXPECT_EQ(entries[2].sum, 12.0);
  EXPECT_EQ(entries[2].squares, 74.0);
}

TEST(BinEnds, HaveEightEntriesEachUpToFourThousandAndNinetySixBins) {
  EXPECT_THAT(bin_ends(entries_at(rising(16))), ElementsAre(8U, 16U));
  EXPECT_THAT(bin_ends(entries_at(rising(23))), ElementsAre(12U, 23U));
  EXPECT_THAT(bin_ends(entries_at(rising(15))), ElementsAre(15U));
  EXPECT_EQ(bin_ends(entries_at(rising(8 * 4096))).size(), 4096U);
  EXPECT_EQ(bin_ends(entries_at(rising(20 * 4096))).size(), 4096U);
}

TEST(BinEnds, FollowTheValuesWhereThoseHaveEightEntriesOnAverage) {
  std::vector<double> x(24, 1.0);
  std::fill(x.begin() + 2, x.begin() + 5, 0.0);
  x.back() = 7.0;
  EXPECT_THAT(bin_ends(entries_at(x)), ElementsAre(3U, 23U, 24U));
}

TEST(BinEnds, NeverPartEqualValues) {
  std::vector<double> x = rising(32);
  std::fill(x.begin() + 4, x.begin() + 13, 5.0);  // over the first bin's end
  EXPECT_THAT(bin_ends(entries_at(x)), ElementsAre(13U, 16U, 24U, 32U));
}

TEST(MergeUnits, MakesOneEntryOfAUnit) {
  std::vector<BinEntry> entries{{0, 5, 1, 2, 4}, {1, 3, 1, 1, 1}, {2, 5, 2, 3, 5}};
  merge_units(entries);
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[0].unit, 3U);
  EXPECT_EQ(entries[1].unit, 5U);
  EXPECT_EQ(entries[1].count, 3.0);
  EXPECT_EQ(entries[1].sum, 5.0);
}

}  // namespace
}  // namespace steerstat
