#include "statistics/sample.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace steerstat {
namespace {

TEST(SortAscending, OrdersNumbersOfEverySignAndSizeAsComparingDoes) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> exponent(0.0, 60.0);
  for (const std::size_t size : {0U, 1U, 2U, 300U, 5000U}) {  // short samples are compared, long ones go by digits
    std::vector<double> sample;
    for (std::size_t i = 0; i < size; ++i) {
      const double magnitude = std::exp2(std::round(exponent(random)));
      sample.push_back(i % 3 == 0 ? -magnitude : magnitude);
    }
    if (size > 2) {
      sample[0] = std::numeric_limits<double>::infinity();
      sample[1] = -std::numeric_limits<double>::denorm_min();
      sample[2] = 0.0;
    }
    std::vector<double> sorted = sample;
    std::sort(sorted.begin(), sorted.end());
    sort_ascending(sample);
    EXPECT_EQ(sample, sorted);
  }
}

TEST(Quantile, MeetsDefinitionSeven) {
  // R: quantile(c(1, 2, 4, 8, 16), c(.05, .25, .5, .6, .95)) of type 7, its default.
  const std::vector<double> sorted{1.0, 2.0, 4.0, 8.0, 16.0};
  EXPECT_NEAR(quantile(sorted, 0.05), 1.2, 1e-15);
  EXPECT_EQ(quantile(sorted, 0.25), 2.0);
  EXPECT_EQ(quantile(sorted, 0.50), 4.0);
  EXPECT_NEAR(quantile(sorted, 0.60), 5.6, 1e-14);
  EXPECT_NEAR(quantile(sorted, 0.95), 14.4, 1e-14);
}

TEST(Quantile, EndsAreTheLeastAndTheGreatestValue) {
  const std::vector<double> sorted{-3.0, 0.1, 7.7};
  EXPECT_EQ(quantile(sorted, 0.0), -3.0);
  EXPECT_EQ(quantile(sorted, 1.0), 7.7);
  EXPECT_LT(quantile(sorted, std::nextafter(1.0, 0.0)), 7.7);
  EXPECT_GE(quantile(sorted, std::numeric_limits<double>::denorm_min()), -3.0);
}

TEST(Quantile, OfOneValueIsThatValue) {
  const std::vector<double> sorted{42.5};
  for (const double p : {0.0, 0.3, 1.0}) EXPECT_EQ(quantile(sorted, p), 42.5);
}

TEST(Quantile, NeverFallsAsTheProbabilityRises) {
  std::mt19937_64 generator(3);
  std::exponential_distribution<double> waits(0.01);
  std::vector<double> sorted(137);
  for (double& x : sorted) x = waits(generator);
  std::sort(sorted.begin(), sorted.end());
  double last = sorted.front();
  for (double p = 0.0; p <= 1.0; p += 1e-4) {
    EXPECT_GE(quantile(sorted, p), last);
    last = quantile(sorted, p);
  }
  EXPECT_LE(last, sorted.back());
}

TEST(Quantile, RefusesAnEmptySampleAndAProbabilityOutsideTheUnitInterval) {
  const std::vector<double> sorted{1.0};
  EXPECT_THROW(quantile({}, 0.5), std::invalid_argument);
  EXPECT_THROW(quantile(sorted, -0.01), std::invalid_argument);
  EXPECT_THROW(quantile(sorted, 1.01), std::invalid_argument);
  EXPECT_THROW(quantile(sorted, std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
}

TEST(Describe, SaysNothingOfAnEmptySample) {
  EXPECT_EQ(describe({}), std::nullopt);
}

TEST(Describe, GivesASampleOfOneNoSpread) {
  const std::vector<double> sample{17.5};
  const SampleStatistics expected{17.5, std::nullopt, 17.5, 17.5, 17.5, 17.5, 17.5, 17.5, 1};
  EXPECT_EQ(describe(sample), expected);
}

TEST(Describe, MeetsAHandComputedSample) {
  const std::vector<double> sample{16.0, 1.0, 4.0, 2.0, 8.0};
  const auto statistics = describe(sample);
  ASSERT_TRUE(statistics);
  EXPECT_EQ(statistics->mean, 6.2);
  EXPECT_NEAR(statistics->std.value(), std::sqrt(37.2), 1e-15);  // 148.8 / 4
  EXPECT_EQ(statistics->min, 1.0);
  EXPECT_NEAR(statistics->p05, 1.2, 1e-15);
  EXPECT_EQ(statistics->p50, 4.0);
  EXPECT_NEAR(statistics->p95, 14.4, 1e-14);
  EXPECT_NEAR(statistics->p99, 15.68, 1e-14);
  EXPECT_EQ(statistics->max, 16.0);
}

TEST(Describe, FindsASmallSpreadBesideALargeMean) {
  // [Chan, Golub and LeVeque 1983]: sums of squares lose all digits here.
  const std::vector<double> sample{1e9 + 1.0, 1e9 + 2.0, 1e9 + 3.0, 1e9 + 4.0};
  EXPECT_EQ(describe(sample)->mean, 1e9 + 2.5);
  EXPECT_NEAR(describe(sample)->std.value(), std::sqrt(5.0 / 3.0), 1e-15);
}

TEST(Describe, HasNoSpreadForAConstantSampleWhateverItsSize) {
  for (std::size_t n = 2; n < 500; ++n) {
    const auto statistics = describe(std::vector<double>(n, 0.1));
    EXPECT_EQ(statistics->mean, 0.1) << n;
    EXPECT_EQ(statistics->std, 0.0) << n;
  }
}

TEST(Describe, IsTheSameBitsInEveryOrderAndOrdersItsValues) {
  std::mt19937_64 generator(4);
  std::lognormal_distribution<double> times(4.5, 0.5);
  std::vector<double> sample(1000);
  for (double& x : sample) x = times(generator);
  const auto first = describe(sample);
  ASSERT_TRUE(first);
  EXPECT_LE(first->min, first->p05);
  EXPECT_LE(first->p05, first->p50);
  EXPECT_LE(first->p50, first->p95);
  EXPECT_LE(first->p95, first->p99);
  EXPECT_LE(first->p99, first->max);
  for (int repeat = 0; repeat < 20; ++repeat) {
    std::shuffle(sample.begin(), sample.end(), generator);
    EXPECT_EQ(describe(sample), first);
  }
}

}  // namespace
}  // namespace steerstat
