#include "sampling/sobol.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "sampling/sobol_dimensions.hpp"

namespace steerstat {
namespace {

std::vector<std::string> names_of(std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.push_back("variable " + std::to_string(i));
  return names;
}

// The order of x in the field's polynomials modulo p, at most 2^degree - 1.
std::uint64_t order_of_x(unsigned p) {
  const unsigned top = std::bit_floor(p);
  unsigned power = 1;
  for (std::uint64_t order = 1;; ++order) {
    power <<= 1U;
    if ((power & top) != 0) power ^= p;
    if (power == 1 || order > top) return order;
  }
}

TEST(SobolDimensions, PolynomialsAreAllPrimitiveOnesUpToDegreeNineInOrder) {
  std::vector<unsigned> primitive;
  for (unsigned p = 3; p < 1024; p += 2) {
    if (order_of_x(p) == std::bit_floor(p) - 1) primitive.push_back(p);
  }
  std::vector<unsigned> listed;
  for (const SobolDimension& dimension : sobol_dimensions) listed.push_back(dimension.polynomial);
  EXPECT_EQ(listed, primitive);
}

TEST(SobolDimensions, InitialNumbersAreOddAndBelowTheirPowerOfTwo) {
  for (const SobolDimension& dimension : sobol_dimensions) {
    for (std::size_t i = 0; i < dimension.initial.size(); ++i) {
      if (i >= dimension.degree()) {
        EXPECT_EQ(dimension.initial[i], 0U);
        continue;
      }
      EXPECT_EQ(dimension.initial[i] % 2, 1U);
      EXPECT_LT(dimension.initial[i], 2U << i);
    }
  }
}

TEST(SobolSequence, FirstPointsAreThePublishedOnes) {
  const SobolSequence sequence(3);
  const auto x = [&](std::uint64_t point, std::size_t dimension) {
    return std::ldexp(static_cast<double>(sequence.at(point, dimension)), -static_cast<int>(SobolSequence::digits));
  };
  const std::vector<std::vector<double>> expected{{0, 0, 0},          {0.5, 0.5, 0.5},       {0.75, 0.25, 0.25},
                                                  {0.25, 0.75, 0.75}, {0.375, 0.375, 0.625}, {0.875, 0.875, 0.125}};
  for (std::size_t point = 0; point < expected.size(); ++point) {
    for (std::size_t dimension = 0; dimension < 3; ++dimension) {
      EXPECT_EQ(x(point, dimension), expected[point][dimension]) << point << ", " << dimension;
    }
  }
}

TEST(SobolSequence, RefusesMoreDimensionsThanItHas) {
  EXPECT_NO_THROW(SobolSequence(SobolSequence::most_dimensions));
  EXPECT_THROW(SobolSequence(SobolSequence::most_dimensions + 1), std::invalid_argument);
}

// Whether the first 2^m draws of a design take every box of 2^-a x 2^-b, a + b + t = m, exactly 2^t times.
bool is_balanced(const Sobol& design, std::size_t first, std::size_t second, unsigned m, unsigned t) {
  for (unsigned a = 0; a + t <= m; ++a) {
    const unsigned b = m - t - a;
    std::vector<unsigned> counts(std::size_t{1} << (a + b));
    for (std::uint64_t draw = 0; draw < std::uint64_t{1} << m; ++draw) {
      const auto i = static_cast<std::size_t>(std::ldexp(design.coordinate(draw, first), static_cast<int>(a)));
      const auto j = static_cast<std::size_t>(std::ldexp(design.coordinate(draw, second), static_cast<int>(b)));
      ++counts[(i << b) + j];
    }
    if (std::any_of(counts.begin(), counts.end(), [&](unsigned count) { return count != 1U << t; })) return false;
  }
  return true;
}

TEST(Sobol, TheFirstPowersOfTwoTakeEveryDyadicIntervalOnceInEveryDimension) {
  const auto names = names_of(SobolSequence::most_dimensions);
  const Sobol design(3, names);
  for (const unsigned m : {0U, 1U, 4U, 8U}) {
    const std::uint64_t n = std::uint64_t{1} << m;
    for (std::size_t variable = 0; variable < names.size(); ++variable) {
      std::set<double> intervals;
      for (std::uint64_t draw = 0; draw < n; ++draw) {
        intervals.insert(std::floor(design.coordinate(draw, variable) * static_cast<double>(n)));
      }
      EXPECT_EQ(intervals.size(), n) << "dimension " << variable;
    }
  }
}

TEST(Sobol, EveryLaterBlockOfAPowerOfTwoIsBalancedToo) {
  const Sobol design(3, names_of(5));
  for (std::uint64_t block = 0; block < 20; ++block) {
    for (std::size_t variable = 0; variable < 5; ++variable) {
      std::set<double> intervals;
      for (std::uint64_t draw = 64 * block; draw < 64 * (block + 1); ++draw) {
        intervals.insert(std::floor(64.0 * design.coordinate(draw, variable)));
      }
      EXPECT_EQ(intervals.size(), 64U);
    }
  }
}

// t of a pair: that of a sequence is at most the sum of (degree - 1) [Sobol 1967]: 0 for the first two dimensions.
TEST(Sobol, PairsAreDigitalNetsOfTheirQuality) {
  const Sobol design(11, names_of(5));
  const std::vector<unsigned> degrees{1, 1, 2, 3, 3};
  for (std::size_t first = 0; first < 5; ++first) {
    for (std::size_t second = first + 1; second < 5; ++second) {
      const unsigned t = degrees[first] + degrees[second] - 2;
      for (unsigned m = t; m <= 9; ++m)
        EXPECT_TRUE(is_balanced(design, first, second, m, t)) << first << ", " << second;
    }
  }
}

TEST(Sobol, TheTestOfBalanceCanFail) {
  const Sobol design(11, names_of(5));
  EXPECT_FALSE(is_balanced(design, 3, 4, 9, 0));
}

TEST(Sobol, TheFirstDrawsOfALargerDesignAreThoseOfASmaller) {
  // A design has no number of draws; a variable that follows others changes none of theirs.
  const Sobol three(7, names_of(3));
  const Sobol five(7, names_of(5));
  for (std::uint64_t draw = 0; draw < 200; ++draw) {
    for (std::size_t variable = 0; variable < 3; ++variable) {
      EXPECT_EQ(three.coordinate(draw, variable), five.coordinate(draw, variable));
    }
  }
}

TEST(Sobol, DrawsStayStrictlyInsideUpToTheLastOne) {
  const Sobol design(7, names_of(3));
  for (const std::uint64_t start : {std::uint64_t{0}, (std::uint64_t{1} << SobolSequence::digits) - 1000}) {
    for (std::uint64_t draw = start; draw < start + 1000; ++draw) {
      EXPECT_GT(design.coordinate(draw, 0), 0.0);
      EXPECT_LT(design.coordinate(draw, 0), 1.0);
    }
  }
}

TEST(Sobol, KeepsTheDrawsItHasAlwaysGiven) {
  const std::vector<std::string> names{"plant.m1", "plant.m2"};
  const Sobol design(1, names);
  EXPECT_EQ(design.coordinate(0, 0), 0x1.1c598f529a82dp-1);
  EXPECT_EQ(design.coordinate(1, 1), 0x1.345900a97a9a2p-2);
  EXPECT_EQ(design.coordinate(1'000'000, 1), 0x1.eb64990d462b1p-1);
}

TEST(Sobol, OnePointIsUniformOverSeeds) {
  constexpr std::size_t seeds = 5000;
  for (const std::uint64_t draw : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{12345}}) {
    std::vector<double> u;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) u.push_back(Sobol(seed, names_of(3)).coordinate(draw, 2));
    std::sort(u.begin(), u.end());
    double distance = 0.0;
    for (std::size_t i = 0; i < seeds; ++i) {
      distance = std::max(distance, std::abs(u[i] - (static_cast<double>(i) + 0.5) / seeds));
    }
    EXPECT_LT(distance, 1.95 / std::sqrt(seeds)) << draw;
  }
}

// The root of the mean square error over seeds, of the mean of a smooth function with mean 1.
double integration_error(unsigned m) {
  constexpr std::uint64_t seeds = 40;
  double square = 0.0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Sobol design(seed, names_of(3));
    double sum = 0.0;
    for (std::uint64_t draw = 0; draw < std::uint64_t{1} << m; ++draw) {
      double product = 1.0;
      for (std::size_t j = 0; j < 3; ++j) product *= 1.0 + (design.coordinate(draw, j) - 0.5);
      sum += product;
    }
    square += std::pow(std::ldexp(sum, -static_cast<int>(m)) - 1.0, 2) / seeds;
  }
  return std::sqrt(square);
}

// n^(-3/2 + e) where independent draws have n^(-1/2) [Owen 1997].
TEST(Sobol, IntegrationErrorFallsFasterThanThatOfIndependentDraws) {
  const double coarse = integration_error(5);
  const double fine = integration_error(10);
  const double independent = std::sqrt((std::pow(1.0 + 1.0 / 12.0, 3) - 1.0) / 1024.0);
  EXPECT_LT(fine, independent / 50.0);
  // 32 times as many draws: 32^-1.5 = 1/181, against 1/5.7 of independent ones; 40 seeds know the ratio to 16 %.
  EXPECT_LT(fine / coarse, 1.0 / 60.0);
}

}  // namespace
}  // namespace steerstat
