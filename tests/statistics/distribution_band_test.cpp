#include "statistics/distribution_band.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

namespace steerstat {
namespace {

/// The farthest that the empirical distribution function of uniform values is from the true one, x.
double farthest(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    distance = std::max({distance, static_cast<double>(i + 1) / n - values[i], values[i] - static_cast<double>(i) / n});
  }
  return distance;
}

TEST(DistributionBand, IsTheClosedForm) {
  EXPECT_NEAR(distribution_band(100, 0.95), 0.13581015157406195, 1e-15);
  EXPECT_NEAR(distribution_band(1, 0.5), std::sqrt(std::log(4.0) / 2.0), 1e-15);
}

TEST(DistributionBand, HoldsTheWholeFunctionAtItsLevelAndHardlyMoreOften) {
  constexpr int repetitions = 4000;
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const std::size_t n : {5U, 50U, 400U}) {
    int covered = 0;
    for (int k = 0; k < repetitions; ++k) {
      std::vector<double> values(n);
      for (double& value : values) value = uniform(generator);
      covered += farthest(values) <= distribution_band(n, 0.9) ? 1 : 0;
    }
    const double share = static_cast<double>(covered) / repetitions;
    const double error = std::sqrt(0.9 * 0.1 / repetitions);
    EXPECT_GE(share, 0.9 - 3.0 * error) << n;
    // The constant is asymptotically exact: from a few hundred values on little is given away.
    if (n == 400U) {
      EXPECT_LE(share, 0.9 + 0.01 + 3.0 * error);
    }
  }
}

TEST(DistributionBand, RefusesNoValuesAndLevelsThatAreNone) {
  EXPECT_THROW(distribution_band(0, 0.95), std::invalid_argument);
  EXPECT_THROW(distribution_band(10, 0.0), std::invalid_argument);
  EXPECT_THROW(distribution_band(10, 1.0), std::invalid_argument);
  EXPECT_NO_THROW(distribution_band(1, 0.999999));
}

}  // namespace
}  // namespace steerstat
