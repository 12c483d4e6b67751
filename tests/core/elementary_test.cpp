#include "core/elementary.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace steerstat {
namespace {

double relative_error(double got, long double expected) {
  return static_cast<double>(std::abs((static_cast<long double>(got) - expected) / expected));
}

TEST(Elementary, SinesAndCosinesAreWithinTheStatedErrorOverFourMillionRadians) {
  double worst = 0.0;
  for (int k = -200000; k <= 200000; ++k) {
    const double x = 0.37 * k + 1e-5 * k * k * (k % 7 - 3) / 100.0;
    if (std::abs(x) > 0x1p22) continue;
    const auto [s, c] = sincos(x);
    worst = std::max(worst, static_cast<double>(std::abs(s - std::sin(static_cast<long double>(x)))));
    worst = std::max(worst, static_cast<double>(std::abs(c - std::cos(static_cast<long double>(x)))));
  }
  EXPECT_LT(worst, 1.5 * 0x1p-53);
}

TEST(Elementary, SineIsOddAndCosineEvenToTheBit) {
  for (double x = 0.0; x < 40.0; x += 0.0173) {
    EXPECT_EQ(sincos(-x).sin, -sincos(x).sin);
    EXPECT_EQ(sincos(-x).cos, sincos(x).cos);
  }
}

TEST(Elementary, SinCosOfANonFiniteAngleIsNotANumber) {
  EXPECT_TRUE(std::isnan(sincos(INFINITY).sin));
  EXPECT_TRUE(std::isnan(sincos(NAN).cos));
}

TEST(Elementary, LogarithmIsWithinFourHalfUlps) {
  for (double x = 1e-300; x < 1e300; x *= 1.37) {
    EXPECT_LT(relative_error(natural_log(x), std::log(static_cast<long double>(x))), 4 * 0x1p-53) << x;
  }
  for (double x = 0.5; x < 2.0; x += 1e-4) {
    EXPECT_NEAR(natural_log(x), static_cast<double>(std::log(static_cast<long double>(x))), 4 * 0x1p-53) << x;
  }
  EXPECT_EQ(natural_log(1.0), 0.0);
  EXPECT_EQ(natural_log(0.0), -INFINITY);
  EXPECT_TRUE(std::isnan(natural_log(-1.0)));
  EXPECT_NEAR(natural_log(5e-324), std::log(5e-324), 1e-12);
}

TEST(Elementary, ExponentialIsWithinFourHalfUlps) {
  for (double x = -700.0; x < 700.0; x += 0.0371) {
    EXPECT_LT(relative_error(exponential(x), std::exp(static_cast<long double>(x))), 4 * 0x1p-53) << x;
  }
  EXPECT_EQ(exponential(0.0), 1.0);
  EXPECT_EQ(exponential(-1e4), 0.0);
  EXPECT_EQ(exponential(1e4), INFINITY);
}

TEST(Elementary, ArcSineIsWithinEightHalfUlpsAndReachesBothEnds) {
  for (double x = 1e-6; x < 1.0; x += 1.7e-4) {
    EXPECT_LT(relative_error(arc_sine(x), std::asin(static_cast<long double>(x))), 8 * 0x1p-53) << x;
  }
  EXPECT_EQ(arc_sine(0.0), 0.0);
  EXPECT_NEAR(arc_sine(1.0), std::numbers::pi / 2, 1e-15);
  EXPECT_TRUE(std::isnan(arc_sine(1.1)));
}

}  // namespace
}  // namespace steerstat
