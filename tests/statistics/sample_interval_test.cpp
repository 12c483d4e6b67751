#include "statistics/sample_interval.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace steerstat {
namespace {

/// P(B <= k) of a binomial count, summed.
double binomial_probability_up_to(std::int64_t k, std::uint64_t n, double p) {
  double sum = 0.0;
  const auto trials = static_cast<double>(n);
  for (std::int64_t i = 0; i <= k; ++i) {
    const auto x = static_cast<double>(i);
    sum += std::exp(std::lgamma(trials + 1.0) - std::lgamma(x + 1.0) - std::lgamma(trials - x + 1.0) + x * std::log(p) +
                    (trials - x) * std::log1p(-p));
  }
  return sum;
}

TEST(QuantileRanks, AreTheInnermostThatEachTailAllows) {
  for (const std::uint64_t n : {1ULL, 6ULL, 40ULL, 300ULL}) {
    for (const double p : {0.05, 0.5, 0.95, 0.99}) {
      for (const double level : {0.5, 0.95, 0.99}) {
        const QuantileRanks ranks = quantile_ranks(n, p, level);
        const double tail = (1.0 - level) / 2.0;
        const auto low = static_cast<std::int64_t>(ranks.low.value_or(0));
        EXPECT_LE(binomial_probability_up_to(low - 1, n, p), tail);
        EXPECT_GT(binomial_probability_up_to(low, n, p), tail);
        const auto high = static_cast<std::int64_t>(ranks.high.value_or(n + 1));
        EXPECT_LE(1.0 - binomial_probability_up_to(high - 1, n, p), tail + 1e-12);
        EXPECT_GT(1.0 - binomial_probability_up_to(high - 2, n, p), tail);
      }
    }
  }
}

TEST(QuantileRanks, NeedAsManyValuesAsTheLevelDemands) {
  // The greatest of n values is above the p-quantile unless all are at or below it: p^n <= (1 - level) / 2.
  EXPECT_FALSE(quantile_ranks(71, 0.95, 0.95).high);    // 0.95^71 = 0.0262
  EXPECT_EQ(quantile_ranks(72, 0.95, 0.95).high, 72U);  // 0.95^72 = 0.0249
  EXPECT_FALSE(quantile_ranks(71, 0.05, 0.95).low);
  EXPECT_EQ(quantile_ranks(72, 0.05, 0.95).low, 1U);
  EXPECT_EQ(quantile_ranks(5, 0.5, 0.95), QuantileRanks{});
  EXPECT_EQ(quantile_ranks(6, 0.5, 0.95), (QuantileRanks{1, 6}));
}

TEST(QuantileRanks, MirrorWhenTheProbabilityDoes) {
  for (const double p : {0.01, 0.05, 0.3}) {
    const QuantileRanks one = quantile_ranks(1000, p, 0.95);
    const QuantileRanks other = quantile_ranks(1000, 1.0 - p, 0.95);
    ASSERT_TRUE(one.low && one.high && other.low && other.high);
    EXPECT_EQ(*one.low, 1001 - *other.high);
    EXPECT_EQ(*one.high, 1001 - *other.low);
  }
}

TEST(QuantileRanks, SpreadAsTheNormalLimitOfALargeSample) {
  const QuantileRanks ranks = quantile_ranks(1'000'000'000, 0.95, 0.95);
  const double reach = 1.959963984540054 * std::sqrt(1e9 * 0.95 * 0.05);
  EXPECT_NEAR(static_cast<double>(ranks.low.value()), 0.95e9 - reach, 3.0);
  EXPECT_NEAR(static_cast<double>(ranks.high.value()), 0.95e9 + reach, 3.0);
}

TEST(QuantileInterval, OfNoValueAndOfOneIsUnbounded) {
  const std::vector<double> one{17.0};
  EXPECT_EQ(quantile_interval({}, 0.5, 0.95), SampleInterval{});
  EXPECT_EQ(quantile_interval(one, 0.5, 0.95), SampleInterval{});
  EXPECT_EQ(quantile_interval(one, 0.5, 1e-9), SampleInterval{});  // either side may be 1/2 at the least
}

TEST(QuantileInterval, CoversAtTheLevelWhateverTheDistributionTiesIncluded) {
  std::mt19937_64 generator(11);
  std::exponential_distribution<double> waits(1.0);
  constexpr int repeats = 4000;
  for (const bool tied : {false, true}) {
    // Rounded up to quarters the values repeat, and their 0.8-quantile is the true one rounded up.
    const auto rounded = [&](double x) { return tied ? std::ceil(4.0 * x) / 4.0 : x; };
    const double truth = rounded(-std::log(0.2));
    int covered = 0;
    for (int repeat = 0; repeat < repeats; ++repeat) {
      std::vector<double> sorted(60);
      for (double& x : sorted) x = rounded(waits(generator));
      std::sort(sorted.begin(), sorted.end());
      const SampleInterval interval = quantile_interval(sorted, 0.8, 0.9);
      covered += interval.low.value() <= truth && truth <= interval.high.value() ? 1 : 0;
    }
    EXPECT_GT(covered, repeats * 0.9 - 3.0 * std::sqrt(repeats * 0.9 * 0.1));
  }
}

TEST(QuantileInterval, RefusesWhatIsNoProbability) {
  const std::vector<double> one{1.0};
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, 1.0, -0.1, 1.1, nan}) {
    EXPECT_THROW(quantile_interval(one, bad, 0.95), std::invalid_argument) << bad;
    EXPECT_THROW(quantile_interval(one, 0.5, bad), std::invalid_argument) << bad;
    EXPECT_THROW(mean_interval(1.0, 1.0, 2, bad), std::invalid_argument) << bad;
  }
}

TEST(MeanInterval, NeedsTwoValues) {
  EXPECT_EQ(mean_interval(0.0, std::nullopt, 0, 0.95), SampleInterval{});
  EXPECT_EQ(mean_interval(3.0, std::nullopt, 1, 0.95), SampleInterval{});
  // Of 2 and 4: mean 3, std sqrt 2, t(0.975; 1) = tan(0.475 pi) = 12.706.
  const SampleInterval two = mean_interval(3.0, std::sqrt(2.0), 2, 0.95);
  EXPECT_NEAR(two.low.value(), 3.0 - 12.706204736174698, 1e-12);
  EXPECT_NEAR(two.high.value(), 3.0 + 12.706204736174698, 1e-12);
}

TEST(MeanInterval, OfAConstantSampleIsAPoint) {
  EXPECT_EQ(mean_interval(0.25, 0.0, 100, 0.99), (SampleInterval{0.25, 0.25}));
}

}  // namespace
}  // namespace steerstat
