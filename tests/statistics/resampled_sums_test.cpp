#include "statistics/resampled_sums.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "known_sensitivities.hpp"

namespace steerstat {
namespace {

std::vector<BinEntry> some_units(std::size_t count) {
  testing_statistics::Draws draws(4);
  std::vector<BinEntry> units;
  for (std::size_t i = 0; i < count; ++i) {
    const double y = draws.next();
    units.push_back({0.0, 7 * i + 3, std::floor(1.0 + 3.0 * draws.next()), y, y * y});
  }
  return units;
}

TEST(ResampledSums, AreThoseOverTheUnitsWhoseBitIsSet) {
  for (const std::size_t count : {0U, 1U, 7U, 8U, 9U, 100U}) {
    const std::vector<BinEntry> units = some_units(count);
    const ResampledSums sums = resampled_sums(units, 11);
    for (std::size_t k = 0; k < resample_count; ++k) {
      UnitSums expected;
      for (const BinEntry& unit : units) {
        const std::uint64_t word = resampling_word(11, unit.unit, k / resamples_a_batch);
        if ((word >> (k % resamples_a_batch) & 1U) != 0) expected.add(unit);
      }
      EXPECT_EQ(sums[k].count, expected.count) << count << ' ' << k;
      EXPECT_NEAR(sums[k].sum, expected.sum, 1e-12) << count << ' ' << k;
      EXPECT_EQ(sums[k].count_squares, expected.count_squares) << count << ' ' << k;
      EXPECT_NEAR(sums[k].sum_squares, expected.sum_squares, 1e-12) << count << ' ' << k;
      EXPECT_NEAR(sums[k].squares, expected.squares, 1e-12) << count << ' ' << k;
    }
  }
}

TEST(ResamplingWord, HasEachBitHalfOfTheTimeAndNoTwoOfThemTogetherMoreOften) {
  constexpr int n = 20'000;
  int ones = 0;
  int neighbours = 0;
  int same_as_next_unit = 0;
  int same_as_next_batch = 0;
  for (std::uint64_t unit = 0; unit < n; ++unit) {
    const std::uint64_t word = resampling_word(1, unit, 0);
    ones += static_cast<int>(word >> 17U & 1U);
    neighbours += static_cast<int>((word >> 17U ^ word >> 18U) & 1U);
    same_as_next_unit += static_cast<int>((word ^ resampling_word(1, unit + 1, 0)) & 1U);
    same_as_next_batch += static_cast<int>((word ^ resampling_word(1, unit, 1)) & 1U);
  }
  const double reach = 4.0 * std::sqrt(n / 4.0);
  for (const int count : {ones, neighbours, same_as_next_unit, same_as_next_batch}) {
    EXPECT_NEAR(count, n / 2, reach);
  }
}

}  // namespace
}  // namespace steerstat
