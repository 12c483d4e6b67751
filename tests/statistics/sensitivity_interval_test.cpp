#include "statistics/sensitivity_interval.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace steerstat {
namespace {

const double none = std::numeric_limits<double>::quiet_NaN();

TEST(BootstrapInterval, ReachesItsQuantileOfStandardErrors) {
  const std::vector<double> resampled{1.0, 2.0, 3.0, 4.0};
  const auto interval = bootstrap_interval(0.5, resampled, 0.95);
  ASSERT_TRUE(interval);
  EXPECT_EQ(interval->estimate, 0.5);
  EXPECT_NEAR(interval->high - 0.5, 1.959963984540054 * std::sqrt(5.0 / 3.0), 1e-12);
  EXPECT_NEAR(0.5 - interval->low, 1.959963984540054 * std::sqrt(5.0 / 3.0), 1e-12);
}

TEST(BootstrapInterval, TakesOffTwiceTheDegenerateVarianceButNeverMoreThanThat) {
  const std::vector<double> resampled{1.0, 2.0, 3.0, 4.0};  // variance 5/3
  const auto reach = [&](double degenerate) {
    return (bootstrap_interval(0.0, resampled, 0.95, degenerate)->high) / 1.959963984540054;
  };
  EXPECT_NEAR(reach(0.5), std::sqrt(5.0 / 3.0 - 1.0), 1e-12);
  EXPECT_NEAR(reach(1.0), 1.0, 1e-12);                   // all of it is degenerate
  EXPECT_NEAR(reach(2.0), std::sqrt(5.0 / 3.0), 1e-12);  // more than resamples show
}

TEST(BootstrapInterval, LeavesOutResamplesWithoutAnEstimateUpToHalf) {
  EXPECT_TRUE(bootstrap_interval(0.0, std::vector<double>{1.0, none, none, 3.0}, 0.95));
  EXPECT_FALSE(bootstrap_interval(0.0, std::vector<double>{1.0, none, none, none}, 0.95));
  EXPECT_FALSE(bootstrap_interval(0.0, std::vector<double>{1.0, 2.0, none, none, none}, 0.95));
  EXPECT_FALSE(bootstrap_interval(none, std::vector<double>{1.0, 2.0}, 0.95));
  EXPECT_FALSE(bootstrap_interval(0.0, {}, 0.95));
}

}  // namespace
}  // namespace steerstat
