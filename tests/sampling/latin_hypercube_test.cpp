#include "sampling/latin_hypercube.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace steerstat {
namespace {

const std::vector<std::string> input_names{"plant.m1", "plant.m2", "initial_state.q2"};

TEST(LatinHypercube, EveryVariableHasOneDrawInEachStratum) {
  for (const std::uint64_t n : {1U, 2U, 3U, 7U, 64U, 1000U, 4097U}) {
    const LatinHypercube design(n, 5, input_names);
    for (std::size_t variable = 0; variable < input_names.size(); ++variable) {
      std::vector<bool> hit(n);
      for (std::uint64_t draw = 0; draw < n; ++draw) {
        const double u = design.coordinate(draw, variable);
        ASSERT_GT(u, 0.0);
        ASSERT_LT(u, 1.0);
        const auto stratum = static_cast<std::size_t>(u * static_cast<double>(n));
        ASSERT_LT(stratum, n);
        ASSERT_FALSE(hit[stratum]) << n << ", variable " << variable;
        hit[stratum] = true;
      }
    }
  }
}

TEST(LatinHypercube, DrawsStayInTheirStratumInTheLargestDesigns) {
  // Where the place in a stratum has the fewest digits; the product with n is not rounded across a bound.
  for (const std::uint64_t n : {1'000'000'000U, 4'294'967'295U}) {
    const LatinHypercube design(n, 1, input_names);
    const Permutation strata(n, 1, "latin_hypercube " + std::to_string(n) + " plant.m1 strata");
    for (std::uint64_t draw = n - 2000; draw < n; ++draw) {
      const long double u = design.coordinate(draw, 0);
      EXPECT_EQ(static_cast<std::uint64_t>(u * static_cast<long double>(n)), strata.at(draw));
    }
  }
}

TEST(LatinHypercube, PlacesInTheStrataAreUniform) {
  constexpr std::uint64_t n = 20'000;
  const LatinHypercube design(n, 9, input_names);
  std::vector<double> places;
  for (std::uint64_t draw = 0; draw < n; ++draw) {
    const double scaled = design.coordinate(draw, 1) * static_cast<double>(n);
    places.push_back(scaled - std::floor(scaled));
  }
  std::sort(places.begin(), places.end());
  double distance = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    distance = std::max(distance, std::abs(places[i] - (static_cast<double>(i) + 0.5) / static_cast<double>(n)));
  }
  EXPECT_LT(distance, 1.95 / std::sqrt(static_cast<double>(n)));  // exceeded once in a thousand samples
}

TEST(LatinHypercube, AVariablesDrawsDoNotDependOnTheOtherVariables) {
  const std::vector<std::string> last{input_names[2]};
  const LatinHypercube alone(50, 5, last);
  const LatinHypercube among(50, 5, input_names);
  for (std::uint64_t draw = 0; draw < 50; ++draw) EXPECT_EQ(alone.coordinate(draw, 0), among.coordinate(draw, 2));
}

TEST(LatinHypercube, SeedsAndNumbersOfDrawsGiveOtherPoints) {
  const LatinHypercube one(50, 1, input_names);
  const LatinHypercube another_seed(50, 2, input_names);
  const LatinHypercube more(51, 1, input_names);
  std::size_t same_stratum = 0;
  for (std::uint64_t draw = 0; draw < 50; ++draw) {
    EXPECT_NE(one.coordinate(draw, 0), another_seed.coordinate(draw, 0));
    EXPECT_NE(one.coordinate(draw, 0), more.coordinate(draw, 0));
    const auto stratum = [&](const LatinHypercube& design) { return std::floor(50.0 * design.coordinate(draw, 0)); };
    if (stratum(one) == stratum(more)) ++same_stratum;
  }
  EXPECT_LT(same_stratum, 8U);  // one is expected
}

TEST(LatinHypercube, KeepsTheDrawsItHasAlwaysGiven) {
  const LatinHypercube design(10, 1, input_names);
  EXPECT_EQ(design.coordinate(0, 0), 0x1.e3777b3d2b1e3p-1);
  EXPECT_EQ(design.coordinate(9, 2), 0x1.5e4ca67e15073p-3);
}

// Of a sum of functions of one variable each, only what varies within strata is left: n^-3 of the variance instead of
// n^-1 [McKay 1979].
TEST(LatinHypercube, IntegratesSumsFarBetterThanIndependentDraws) {
  constexpr std::uint64_t n = 100;
  constexpr std::uint64_t seeds = 50;
  double square = 0.0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const LatinHypercube design(n, seed, input_names);
    double sum = 0.0;
    for (std::uint64_t draw = 0; draw < n; ++draw) {
      for (std::size_t variable = 0; variable < 3; ++variable) sum += design.coordinate(draw, variable) - 0.5;
    }
    square += std::pow(sum / n, 2) / seeds;
  }
  // The mean of 3 n places in strata of width 1 / n.
  const double expected = 3.0 / (12.0 * std::pow(n, 3));
  EXPECT_NEAR(square / expected, 1.0, 4.5 * std::sqrt(2.0 / seeds));
  EXPECT_LT(square, 1e-3 * 3.0 / (12.0 * n));  // of independent draws
}

}  // namespace
}  // namespace steerstat
