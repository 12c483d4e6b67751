#include "core/normal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace steerstat {
namespace {

/// The standard normal distribution function, in extended precision.
long double probability_below(double z) {
  return 0.5L * std::erfc(-static_cast<long double>(z) / std::numbers::sqrt2_v<long double>);
}

TEST(NormalQuantile, MeetsPublishedValues) {
  // The worked examples of [Wichura 1988], then the usual confidence levels.
  EXPECT_NEAR(normal_quantile(0.25), -0.6744897501960817, 1e-15);
  EXPECT_NEAR(normal_quantile(0.001), -3.090232306167814, 4e-15);
  EXPECT_NEAR(normal_quantile(1e-20), -9.262340089798408, 1e-14);
  EXPECT_NEAR(normal_quantile(0.95), 1.6448536269514722, 2e-15);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 2e-15);
  EXPECT_NEAR(normal_quantile(0.995), 2.5758293035489004, 4e-15);
}

TEST(NormalQuantile, InvertsTheDistributionFunctionFromTheMiddleToTheFarTail) {
  const auto check = [](double p) {
    const double z = normal_quantile(p);
    const auto relative = static_cast<double>((probability_below(z) - static_cast<long double>(p)) / p);
    // A relative error e of z changes the tail's probability by about z^2 e.
    EXPECT_LT(std::abs(relative), 1e-15 * (1.0 + z * z)) << "p = " << p;
  };
  for (double p = 1e-300; p < 0.07; p *= 1.7) check(p);
  for (double p = 0.07; p <= 0.5; p += 1e-4) check(p);
}

TEST(NormalQuantile, IsOddAboutOneHalfToTheBit) {
  EXPECT_EQ(normal_quantile(0.5), 0.0);
  for (int k = 1; k < 512; ++k) {  // dyadic, so that 1 - p is exact
    const double p = k / 1024.0;
    EXPECT_EQ(normal_quantile(1.0 - p), -normal_quantile(p));
  }
}

TEST(NormalQuantile, RisesAcrossTheBordersOfItsPieces) {
  for (const double border : {0.075, 0.925, 1.3887943864964021e-11}) {  // |q| = 0.425 and r = 5
    const double step = border * 1e-9;
    EXPECT_LT(normal_quantile(border - step), normal_quantile(border));
    EXPECT_LT(normal_quantile(border), normal_quantile(border + step));
    EXPECT_NEAR(normal_quantile(border + step) - normal_quantile(border - step), 0.0, 1e-7);
  }
}

TEST(NormalQuantile, IsInfiniteAtTheEndsAndNotANumberBeyondThem) {
  EXPECT_EQ(normal_quantile(0.0), -INFINITY);
  EXPECT_EQ(normal_quantile(1.0), INFINITY);
  EXPECT_TRUE(std::isfinite(normal_quantile(std::numeric_limits<double>::denorm_min())));
  EXPECT_TRUE(std::isnan(normal_quantile(-1e-300)));
  EXPECT_TRUE(std::isnan(normal_quantile(1.0 + 1e-15)));
  EXPECT_TRUE(std::isnan(normal_quantile(NAN)));
}

}  // namespace
}  // namespace steerstat
