#include "statistics/slope.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace steerstat {
namespace {

TEST(LeastSquaresSlope, IsThatOfALineAndOfTheBestOneThroughOthers) {
  EXPECT_NEAR(least_squares_slope(std::vector<double>{1, 2, 4}, std::vector<double>{5, 3, -1}), -2.0, 1e-15);
  // Anscombe's first data set: the slope is published as 0.500 [Anscombe 1973].
  const std::vector<double> x{10, 8, 13, 9, 11, 14, 6, 4, 12, 7, 5};
  const std::vector<double> y{8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68};
  EXPECT_NEAR(least_squares_slope(x, y), 0.50009, 0.5e-5);
}

TEST(LeastSquaresSlope, RefusesWhatHasNoSlope) {
  EXPECT_THROW(least_squares_slope({}, {}), std::invalid_argument);
  EXPECT_THROW(least_squares_slope(std::vector<double>{1, 1}, std::vector<double>{1, 2}), std::invalid_argument);
  EXPECT_THROW(least_squares_slope(std::vector<double>{1, 2}, std::vector<double>{1}), std::invalid_argument);
}

}  // namespace
}  // namespace steerstat
