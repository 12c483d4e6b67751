#include "sampling/correlation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sampling/stream.hpp"

namespace steerstat {
namespace {

using ::testing::ElementsAre;
using Pairs = std::vector<PairCorrelation>;

TEST(FactoriseCorrelation, OfTwoVariablesIsKnown) {
  const auto factor = factorise_correlation(2, Pairs{{0, 1, 0.6}});
  ASSERT_TRUE(factor);
  EXPECT_THAT(factor->elements, ElementsAre(1.0, 0.0, 0.6, 0.8));
}

TEST(FactoriseCorrelation, TheOrderOfAPairDoesNotMatter) {
  EXPECT_EQ(factorise_correlation(3, Pairs{{2, 0, -0.3}})->elements,
            factorise_correlation(3, Pairs{{0, 2, -0.3}})->elements);
}

TEST(FactoriseCorrelation, UncorrelatedVariablesHaveTheIdentitysRow) {
  const auto factor = factorise_correlation(4, Pairs{{0, 1, 0.9}, {2, 3, -0.9}});
  ASSERT_TRUE(factor);
  EXPECT_EQ(factor->at(2, 0), 0.0);
  EXPECT_EQ(factor->at(2, 1), 0.0);
  EXPECT_EQ(factor->at(2, 2), 1.0);
}

// Correlations of random directions: of any number of variables, always possible.
Pairs possible_correlations(std::size_t size) {
  const UniformStream stream(3, "directions");
  std::vector<std::vector<double>> directions(size, std::vector<double>(size + 2));
  std::uint64_t index = 0;
  for (auto& direction : directions) {
    double square = 0.0;
    for (double& x : direction) {
      x = stream.at(index++) - 0.5;
      square += x * x;
    }
    for (double& x : direction) x /= std::sqrt(square);
  }
  Pairs pairs;
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = i + 1; j < size; ++j) {
      double product = 0.0;
      for (std::size_t k = 0; k < directions[i].size(); ++k) product += directions[i][k] * directions[j][k];
      pairs.push_back({i, j, product});
    }
  }
  return pairs;
}

TEST(FactoriseCorrelation, SquaredItGivesTheMatrixBack) {
  for (const std::size_t size : {1U, 2U, 3U, 8U, 40U}) {
    const Pairs pairs = possible_correlations(size);
    const auto factor = factorise_correlation(size, pairs);
    ASSERT_TRUE(factor) << size;
    const auto product = [&](std::size_t i, std::size_t j) {
      double sum = 0.0;
      for (std::size_t k = 0; k < size; ++k) sum += factor->at(i, k) * factor->at(j, k);
      return sum;
    };
    for (std::size_t i = 0; i < size; ++i) EXPECT_NEAR(product(i, i), 1.0, 1e-14);
    for (const PairCorrelation& pair : pairs) {
      EXPECT_NEAR(product(pair.first, pair.second), pair.correlation, 1e-14);
    }
  }
}

TEST(FactoriseCorrelation, KeepsTheBitsItHasAlwaysGiven) {
  const auto factor = factorise_correlation(3, Pairs{{0, 1, 0.3}, {0, 2, -0.7}, {1, 2, 0.1}});
  ASSERT_TRUE(factor);
  EXPECT_EQ(factor->at(2, 1), 0x1.4cc47d685c4c6p-2);
  EXPECT_EQ(factor->at(2, 2), 0x1.459772398fc22p-1);
}

TEST(FactoriseCorrelation, RefusesWhatLeavesAVariableLessThanTheLeastVariance) {
  // Two variables: what is left is 1 - rho^2.
  EXPECT_TRUE(factorise_correlation(2, Pairs{{0, 1, std::sqrt(1.0 - 1.01 * least_conditional_variance)}}));
  EXPECT_FALSE(factorise_correlation(2, Pairs{{0, 1, std::sqrt(1.0 - 0.99 * least_conditional_variance)}}));
}

TEST(FactoriseCorrelation, RefusesThreeThatContradictOneAnotherOnBothSidesOfTheBound) {
  // 0.8 and 0.8 leave the third at least 2 0.8^2 - 1 = 0.28.
  EXPECT_TRUE(factorise_correlation(3, Pairs{{0, 1, 0.8}, {1, 2, 0.8}, {0, 2, 0.2801}}));
  EXPECT_FALSE(factorise_correlation(3, Pairs{{0, 1, 0.8}, {1, 2, 0.8}, {0, 2, 0.28}}));  // singular
  EXPECT_FALSE(factorise_correlation(3, Pairs{{0, 1, 0.8}, {1, 2, 0.8}, {0, 2, 0.2799}}));
}

TEST(ContradictingVariables, AreThoseOfWhomNoneCanBeLeftOut) {
  const Pairs pairs{{0, 1, 0.5}, {1, 3, 0.8}, {3, 4, 0.8}, {1, 4, -0.8}, {2, 5, 0.9}};
  EXPECT_THAT(contradicting_variables(6, pairs), ElementsAre(1, 3, 4));
}

TEST(ContradictingVariables, CanBeTwo) {
  EXPECT_THAT(contradicting_variables(3, Pairs{{0, 2, 1.0 - 1e-15}}), ElementsAre(0, 2));
}

}  // namespace
}  // namespace steerstat
