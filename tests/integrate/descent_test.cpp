#include "integrate/descent.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace steerstat {
namespace {

/// scale times the product of (x - root).
std::vector<double> polynomial(double scale, const std::vector<double>& roots) {
  std::vector<double> p{scale};
  for (const double root : roots) {
    p.push_back(0.0);
    for (std::size_t k = p.size() - 1; k > 0; --k) p[k] = p[k - 1] - root * p[k];
    p[0] *= -root;
  }
  return p;
}

std::optional<double> descent(const std::vector<double>& p, bool armed = true) {
  return first_descent(p, armed);
}

TEST(FirstDescent, IsAtTheRootWhereThePolynomialFalls) {
  EXPECT_NEAR(*descent(polynomial(-1.0, {0.3})), 0.3, 1e-15);
  EXPECT_EQ(descent(polynomial(1.0, {0.3}), false), std::nullopt) << "it rises there";
  EXPECT_NEAR(*descent(polynomial(-1.0, {0.2, 0.5, 0.7}), false), 0.2, 1e-14);
  EXPECT_NEAR(*descent(polynomial(1.0, {0.2, 0.5, 0.7}), false), 0.5, 1e-14);
}

TEST(FirstDescent, LooksAtTheIntervalAlone) {
  EXPECT_EQ(descent(polynomial(-1.0, {1.0 + 1e-12})), std::nullopt);
  EXPECT_NEAR(*descent(polynomial(-1.0, {1.0})), 1.0, 1e-15);
  EXPECT_EQ(descent(polynomial(1.0, {-0.1, 1.1})).value_or(-1.0), 0.0) << "armed and negative from the start";
}

TEST(FirstDescent, FindsADipHoweverShort) {
  for (const double width : {1e-1, 1e-3, 1e-6}) {
    const double at = 0.37;
    EXPECT_NEAR(*descent(polynomial(1.0, {at, at + width})), at, 1e-15 / width) << width;
  }
}

TEST(FirstDescent, LeavesADipThatMissesZero) {
  std::vector<double> p = polynomial(1.0, {0.37, 0.37});
  p[0] += 1e-12;
  EXPECT_EQ(descent(p), std::nullopt);
  p[0] -= 2e-12;
  EXPECT_NEAR(descent(p).value_or(-1.0), 0.37 - 1e-6, 1e-9);
}

TEST(FirstDescent, WaitsUntilThePolynomialHasBeenPositive) {
  bool armed = false;
  EXPECT_EQ(first_descent(polynomial(-1.0, {-0.5}), armed), std::nullopt);
  EXPECT_FALSE(armed);
  EXPECT_EQ(first_descent(polynomial(1.0, {0.5}), armed), std::nullopt);
  EXPECT_TRUE(armed);
  armed = false;
  EXPECT_NEAR(*first_descent(polynomial(-1.0, {0.5, 0.51}), armed), 0.51, 1e-13);
}

TEST(FirstDescent, TakesConstants) {
  EXPECT_EQ(descent({1.0}), std::nullopt);
  EXPECT_EQ(descent({-1.0}, false), std::nullopt);
  EXPECT_EQ(descent({0.0}).value_or(-1.0), 0.0);
}

TEST(FirstDescent, AgreesWithTheRootsOfRandomPolynomials) {
  std::mt19937_64 generator(4);
  std::uniform_real_distribution<double> uniform(-0.5, 1.5);
  int found = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<double> roots(1 + generator() % 6);
    for (double& root : roots) root = uniform(generator);
    std::ranges::sort(roots);
    const double scale = generator() % 2 == 0 ? 1.0 : -1.0;
    const auto value = [&](double x) {
      double product = scale;
      for (const double root : roots) product *= x - root;
      return product;
    };
    double expected = -1.0;
    for (std::size_t i = 0; i < roots.size() && expected < 0.0; ++i) {
      const double before = i == 0 ? -1.0 : roots[i - 1];
      const double middle = 0.5 * (std::max(before, 0.0) + roots[i]);
      if (roots[i] > 0.0 && roots[i] <= 1.0 && value(middle) > 0.0) expected = roots[i];
    }
    const std::optional<double> crossing = descent(polynomial(scale, roots), false);
    ASSERT_NEAR(crossing.value_or(-1.0), expected, 1e-6) << trial;
    found += crossing ? 1 : 0;
  }
  EXPECT_GT(found, 500);
}

TEST(FirstDescent, TakesTheHighestDegree) {
  std::vector<double> p(highest_degree + 1, 0.0);
  p[0] = 0.5;
  p[highest_degree] = -1.0;  // 0.5 - x^24
  EXPECT_NEAR(*descent(p), std::pow(0.5, 1.0 / 24.0), 1e-14);
}

}  // namespace
}  // namespace steerstat
