#include "control/cycle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/polynomial.hpp"

namespace steerstat {
namespace {

/// A rational number in lowest terms, so that the claims about (11) are checked without rounding.
struct Fraction {
  std::int64_t numerator{0};
  std::int64_t denominator{1};

  static Fraction of(std::int64_t n, std::int64_t d) {
    const std::int64_t divisor = std::gcd(n, d) * (d < 0 ? -1 : 1);
    return {n / divisor, d / divisor};
  }
  friend Fraction operator+(Fraction a, Fraction b) {
    return of(a.numerator * b.denominator + b.numerator * a.denominator, a.denominator * b.denominator);
  }
  friend Fraction operator*(Fraction a, Fraction b) {
    return of(a.numerator * b.numerator, a.denominator * b.denominator);
  }
  friend bool operator==(Fraction, Fraction) = default;
};

using Coefficients = std::vector<Fraction>;  // lowest power first

Coefficients integral_of(const Coefficients& p) {
  Coefficients result{{}};
  for (std::size_t k = 0; k < p.size(); ++k) {
    result.push_back(p[k] * Fraction{1, static_cast<std::int64_t>(k) + 1});
  }
  return result;
}

Coefficients product_of(const Coefficients& p, const Coefficients& q) {
  Coefficients result(p.size() + q.size() - 1);
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t k = 0; k < q.size(); ++k) result[i + k] = result[i + k] + p[i] * q[k];
  }
  return result;
}

Fraction at_one(const Coefficients& p) {
  return std::accumulate(p.begin(), p.end(), Fraction{});
}

/// (11)'s polynomial.
Coefficients acceleration() {
  Coefficients p{{}};
  for (const double c : cycle_coefficients) p.push_back({static_cast<std::int64_t>(c), 1});
  return p;
}

TEST(Cycle, AccelerationVanishesAtBothEnds) {
  EXPECT_EQ(acceleration().front(), (Fraction{0, 1}));
  EXPECT_EQ(at_one(acceleration()), (Fraction{0, 1}));
  EXPECT_EQ(cycle_acceleration(3.0, 2.0, 0.0), 0.0);
  EXPECT_EQ(cycle_acceleration(3.0, 2.0, 2.0), 0.0);
}

TEST(Cycle, BringsTheFirstJointBackAtRest) {
  const Coefficients velocity = integral_of(acceleration());
  EXPECT_EQ(at_one(velocity), (Fraction{0, 1}));
  EXPECT_EQ(at_one(integral_of(velocity)), (Fraction{0, 1}));
}

TEST(Cycle, IntegralOfTheFirstJointsDisplacementIsZero) {
  EXPECT_EQ(at_one(integral_of(integral_of(integral_of(acceleration())))), (Fraction{0, 1}));
}

TEST(Cycle, BetaIsHalfTheIntegralOfTheSquaredVelocity) {
  const Coefficients velocity = integral_of(acceleration());
  const Fraction half_integral = at_one(integral_of(product_of(velocity, velocity))) * Fraction{1, 2};
  EXPECT_EQ(half_integral, (Fraction{3, 80080}));
  EXPECT_EQ(beta, static_cast<double>(half_integral.numerator) / static_cast<double>(half_integral.denominator));
}

TEST(Cycle, AccelerationIsThePolynomialScaledByAmplitudeAndPeriod) {
  for (const double lambda : {0.1, 0.33, 0.5, 0.9}) {
    const double p = 3 * lambda - 30 * std::pow(lambda, 2) + 90 * std::pow(lambda, 3) - 105 * std::pow(lambda, 4) +
                     42 * std::pow(lambda, 5);
    EXPECT_NEAR(cycle_acceleration(1.0, 1.0, lambda), p, 1e-14);
    EXPECT_NEAR(cycle_acceleration(-7.0, 2.0, 2.0 * lambda), -7.0 / 4.0 * p, 1e-13);
  }
}

TEST(Cycle, AccelerationIsOddAboutTheMiddle) {
  const double rounding = 270.0 * 0x1p-53;  // 270 is the sum of the coefficients' sizes
  for (double lambda = 0.0; lambda <= 0.5; lambda += 0.01) {
    EXPECT_NEAR(cycle_acceleration(1.0, 1.0, 1.0 - lambda), -cycle_acceleration(1.0, 1.0, lambda), rounding);
  }
}

TEST(Cycle, PeakBoundsTheAccelerationAndIsReached) {
  double largest = 0.0;
  for (int i = 0; i <= 1000000; ++i) largest = std::max(largest, std::abs(cycle_acceleration(1.0, 1.0, i * 1e-6)));
  EXPECT_LE(largest, cycle_peak);
  EXPECT_GT(largest, cycle_peak - 1e-5);
}

TEST(Polynomial, IntegralAndProductAgreeWithExactRationals) {
  constexpr std::array<double, 4> p{1.0, -2.0, 3.0, 0.5};
  constexpr std::array<double, 3> q{4.0, 0.0, -1.0};
  static_assert(integral(p) == std::array<double, 5>{0.0, 1.0, -1.0, 1.0, 0.125});
  static_assert(product(p, q) == std::array<double, 6>{4.0, -8.0, 11.0, 4.0, -3.0, -0.5});
  EXPECT_EQ(evaluate(p, 2.0), 1.0 - 4.0 + 12.0 + 4.0);
  EXPECT_EQ(evaluate(std::array<double, 1>{5.0}, 2.0), 5.0);
}

}  // namespace
}  // namespace steerstat
