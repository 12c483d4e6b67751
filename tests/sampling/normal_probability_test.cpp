#include "sampling/normal_probability.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/normal.hpp"

namespace steerstat {
namespace {

// Of erfc in long double, whose own error is far below the claims.
long double reference(double z) {
  return 0.5L * std::erfc(-static_cast<long double>(z) / std::numbers::sqrt2_v<long double>);
}

double worst_relative_error(double (*probability)(double), double from, double to) {
  double worst = 0.0;
  for (double z = from; z < to; z += 0.000937) {
    const long double expected = reference(z);
    worst = std::max(worst, static_cast<double>(std::abs((probability(z) - expected) / expected)));
  }
  return worst;
}

TEST(NormalProbability, HasTheStatedRelativeError) {
  EXPECT_LT(worst_relative_error(normal_probability, -37.0, 9.0), 2e-15);
}

TEST(QuickNormalProbability, HasTheStatedRelativeError) {
  EXPECT_LT(worst_relative_error(quick_normal_probability, -37.0, 9.0), 2e-15);
}

TEST(QuickNormalProbability, ReachesBothEndsAndPassesNotANumberOn) {
  EXPECT_EQ(quick_normal_probability(0.0), 0.5);
  EXPECT_EQ(quick_normal_probability(-INFINITY), 0.0);
  EXPECT_EQ(quick_normal_probability(INFINITY), 1.0);
  EXPECT_TRUE(std::isnan(quick_normal_probability(NAN)));
}

TEST(QuickNormalProbability, ItsApproximationsMeetWithoutAStep) {
  for (const double z : {-0x1.6a09e667f3bcdp+2, -0.66291, 0.66291}) {
    const double below = quick_normal_probability(std::nextafter(z, -INFINITY));
    const double above = quick_normal_probability(std::nextafter(z, INFINITY));
    const double rise = 2.0 * std::abs(z) * std::abs(z) * 0x1p-52;  // of ln P below 0 over two neighbours
    EXPECT_NEAR(above / below, 1.0, 4e-15 + rise) << z;
  }
}

TEST(NormalProbability, MatchesPublishedValues) {
  EXPECT_EQ(normal_probability(0.0), 0.5);
  EXPECT_NEAR(normal_probability(-1.0), 0.15865525393145705, 1e-16);
  EXPECT_NEAR(normal_probability(3.0), 0.99865010196836990547, 2e-16);
  EXPECT_NEAR(normal_probability(-8.0) / 6.2209605742717841235e-16, 1.0, 1e-14);
}

TEST(NormalProbability, ReachesBothEndsAndPassesNotANumberOn) {
  EXPECT_EQ(normal_probability(-INFINITY), 0.0);
  EXPECT_EQ(normal_probability(INFINITY), 1.0);
  EXPECT_EQ(normal_probability(-40.0), 0.0);
  EXPECT_TRUE(std::isnan(normal_probability(NAN)));
}

TEST(NormalProbability, SeriesAndFractionMeetWithoutAStep) {
  for (const double z : {-1.0, 1.0}) {
    const double below = normal_probability(std::nextafter(z, -INFINITY));
    const double above = normal_probability(std::nextafter(z, INFINITY));
    EXPECT_NEAR(above, below, 4e-16) << z;
  }
}

TEST(NormalProbability, InvertsTheNormalQuantile) {
  for (double p = 1e-12; p < 1.0; p += 0.00137) {
    EXPECT_NEAR(normal_probability(normal_quantile(p)), p, 4e-16 + 1e-14 * p * (1.0 - p)) << p;
  }
}

}  // namespace
}  // namespace steerstat
