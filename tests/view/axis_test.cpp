#include "view/axis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace steerstat {
namespace {

using ::testing::ElementsAre;

const Input uniform_mass{"plant.m1", Distribution{Uniform{0.8, 1.2}}};
const Input normal_speed{"initial_state.q2_dot", Distribution{Normal{0.0, 1.0}}};

TEST(Axis, HasItsLowerEdgesInEachBinAndItsUpperEdgeInTheLast) {
  const std::vector<double> values{0.0, 1.0, 4.0};
  const Axis axis = axis_of(uniform_mass, false, values, 4);
  ASSERT_THAT(axis.edges, ElementsAre(0.0, 1.0, 2.0, 3.0, 4.0));
  EXPECT_EQ(axis.unit, "kg");
  EXPECT_EQ(axis.bin_of(0.0), 0U);
  EXPECT_EQ(axis.bin_of(std::nextafter(1.0, 0.0)), 0U);
  EXPECT_EQ(axis.bin_of(1.0), 1U);
  EXPECT_EQ(axis.bin_of(std::nextafter(4.0, 0.0)), 3U);
  EXPECT_EQ(axis.bin_of(4.0), 3U);
  EXPECT_EQ(axis.bin_of(std::nextafter(0.0, -1.0)), std::nullopt);
  EXPECT_EQ(axis.bin_of(std::nextafter(4.0, 5.0)), std::nullopt);
  EXPECT_EQ(axis.bin_of(std::nan("")), std::nullopt);
}

TEST(Axis, PutsEveryValueBetweenTheEdgesOfItsBinHoweverTheyRound) {
  std::vector<double> values;
  for (int i = 0; i <= 3000; ++i) values.push_back(0.1 + 1e-3 * i / 3.0);
  const Axis axis = axis_of(uniform_mass, false, values, 37);
  for (std::size_t k = 0; k < axis.bins(); ++k) {
    EXPECT_EQ(axis.bin_of(axis.edges[k]), k);
    if (k > 0) {
      EXPECT_EQ(axis.bin_of(std::nextafter(axis.edges[k], 0.0)), k - 1);
    }
  }
}

TEST(Axis, HasTheLevelsOfASweepOrADiscreteOrAListedInputThatHasFew) {
  const std::vector<double> values{3.0, 1.0, 3.0, 2.0};
  EXPECT_THAT(axis_of({"plant.f2", Sweep{{3.0, 1.0, 2.0}}}, false, values, 10).levels, ElementsAre(1.0, 2.0, 3.0));
  EXPECT_THAT(axis_of({"plant.f2", 0.0}, true, values, 10).levels, ElementsAre(1.0, 2.0, 3.0));
  const Axis discrete =
      axis_of({"plant.f2", Distribution{Discrete{{1.0, 2.0, 3.0}, {0.2, 0.3, 0.5}}}}, false, values, 10);
  EXPECT_EQ(discrete.bins(), 3U);
  EXPECT_EQ(discrete.bin_of(2.0), 1U);
  EXPECT_EQ(discrete.bin_of(2.5), std::nullopt);
}

TEST(Axis, PutsManyLevelsIntoBinsOfEqualWidth) {
  std::vector<double> values(most_levels);
  std::iota(values.begin(), values.end(), 0.0);
  EXPECT_EQ(axis_of({"plant.f2", 0.0}, true, values, 10).levels.size(), most_levels);
  values.push_back(static_cast<double>(most_levels));
  const Axis axis = axis_of({"plant.f2", 0.0}, true, values, 10);
  EXPECT_TRUE(axis.levels.empty());
  EXPECT_EQ(axis.bins(), 10U);
}

TEST(Axis, IsOneLevelWhereAllValuesAreAlike) {
  const std::vector<double> values{0.9, 0.9};
  EXPECT_THAT(axis_of(uniform_mass, false, values, 10).levels, ElementsAre(0.9));
}

TEST(Axis, SpansAllOfABoundedInputAndLeavesTheTailsOfAnUnboundedOneOutside) {
  std::vector<double> values;
  for (int i = 0; i < 10001; ++i) values.push_back(i);
  values.front() = -1e6;
  values.back() = 1e6;
  const Axis bounded = axis_of(uniform_mass, false, values, 10);
  EXPECT_EQ(bounded.edges.front(), -1e6);
  EXPECT_EQ(bounded.edges.back(), 1e6);
  const Axis unbounded = axis_of(normal_speed, false, values, 10);
  EXPECT_EQ(unbounded.edges.front(), 10.0);
  EXPECT_EQ(unbounded.edges.back(), 9990.0);
}

TEST(CountBins, CountsEveryTrialOnceOrOutside) {
  const std::vector<std::uint16_t> x{0, 1, 1, outside_axis, 1};
  const std::vector<std::uint16_t> y{0, 0, 2, 1, outside_axis};
  const std::vector<std::uint8_t> converged{1, 0, 1, 1, 1};
  const BinCounts along = count_bins(2, x, converged);
  EXPECT_THAT(along.trials, ElementsAre(1, 3));
  EXPECT_THAT(along.successes, ElementsAre(1, 2));
  EXPECT_EQ(along.outside, 1U);
  const BinCounts plane = count_bins(2, x, 3, y, converged);
  EXPECT_THAT(plane.trials, ElementsAre(1, 1, 0, 0, 0, 1));
  EXPECT_THAT(plane.successes, ElementsAre(1, 0, 0, 0, 0, 1));
  EXPECT_EQ(plane.outside, 2U);
}

}  // namespace
}  // namespace steerstat
