#include "statistics/proportion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "core/normal.hpp"

namespace steerstat {
namespace {

/// Probability that a binomial count of n trials has its interval cover the true p; (n + 1) intervals.
double coverage(const std::vector<ProportionInterval>& intervals, double p) {
  const auto n = static_cast<double>(intervals.size() - 1);
  double covered = 0.0;
  for (std::size_t x = 0; x < intervals.size(); ++x) {
    if (p < intervals[x].low || p > intervals[x].high) continue;
    const auto k = static_cast<double>(x);
    covered += std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) + k * std::log(p) +
                        (n - k) * std::log1p(-p));
  }
  return covered;
}

std::vector<ProportionInterval> all_intervals(std::uint64_t n, double level) {
  std::vector<ProportionInterval> intervals;
  for (std::uint64_t x = 0; x <= n; ++x) intervals.push_back(wilson_interval(x, n, level));
  return intervals;
}

TEST(WilsonInterval, MeetsThePublishedTable) {
  // [Newcombe 1998], table I, method 3, level 0.95.
  const struct {
    std::uint64_t successes, trials;
    double low, high;
  } rows[] = {{81, 263, 0.2553, 0.3662}, {15, 148, 0.0624, 0.1605}, {0, 20, 0.0, 0.1611}, {1, 29, 0.0061, 0.1718}};
  for (const auto& row : rows) {
    const ProportionInterval interval = wilson_interval(row.successes, row.trials, 0.95);
    EXPECT_NEAR(interval.low, row.low, 0.5e-4) << row.successes << " of " << row.trials;
    EXPECT_NEAR(interval.high, row.high, 0.5e-4) << row.successes << " of " << row.trials;
    EXPECT_EQ(interval.level, 0.95);
  }
}

TEST(WilsonInterval, IsClosedAtNoneAndAtAllSuccesses) {
  for (const std::uint64_t n : {1ULL, 2ULL, 10ULL, 997ULL, 1000000ULL}) {
    for (const double level : {0.5, 0.9, 0.95, 0.999}) {
      const double z = normal_quantile((1.0 + level) / 2.0);
      const double reach = z * z / (static_cast<double>(n) + z * z);
      const ProportionInterval none = wilson_interval(0, n, level);
      EXPECT_EQ(none.estimate, 0.0);
      EXPECT_EQ(none.low, 0.0);
      EXPECT_NEAR(none.high, reach, 1e-13 * reach);
      const ProportionInterval all = wilson_interval(n, n, level);
      EXPECT_EQ(all.estimate, 1.0);
      EXPECT_NEAR(all.low, 1.0 - reach, 1e-13);
      EXPECT_EQ(all.high, 1.0);
    }
  }
}

TEST(WilsonInterval, LimitsAreWhereTheScoreTestJustRejects) {
  for (const std::uint64_t n : {3ULL, 40ULL, 100000ULL}) {
    for (std::uint64_t x = 1; x < n; x += 1 + n / 37) {
      const ProportionInterval interval = wilson_interval(x, n, 0.95);
      for (const double limit : {interval.low, interval.high}) {
        const double score = (interval.estimate - limit) / std::sqrt(limit * (1.0 - limit) / static_cast<double>(n));
        EXPECT_NEAR(std::abs(score), 1.959963984540054, 1e-9) << x << " of " << n;
      }
    }
  }
}

TEST(WilsonInterval, MirrorsWhenSuccessAndFailureSwap) {
  for (std::uint64_t x = 0; x <= 83; ++x) {
    const ProportionInterval one = wilson_interval(x, 83, 0.9);
    const ProportionInterval other = wilson_interval(83 - x, 83, 0.9);
    EXPECT_NEAR(one.low, 1.0 - other.high, 1e-15);
    EXPECT_NEAR(one.high, 1.0 - other.low, 1e-15);
  }
}

TEST(WilsonInterval, HoldsItsEstimateInsideTheUnitIntervalAndGrowsWithTheLevel) {
  for (const std::uint64_t n : {1ULL, 7ULL, 5000ULL, 1ULL << 62}) {
    for (std::uint64_t k = 0; k <= 7; ++k) {
      const std::uint64_t x = n / 7 * k;
      ProportionInterval inner{};
      for (const double level : {0.1, 0.5, 0.9, 0.99, 0.999999}) {
        const ProportionInterval outer = wilson_interval(x, n, level);
        EXPECT_LE(0.0, outer.low);
        EXPECT_LE(outer.low, outer.estimate);
        EXPECT_LE(outer.estimate, outer.high);
        EXPECT_LE(outer.high, 1.0);
        if (level > 0.1) {
          EXPECT_LE(outer.low, inner.low);
          EXPECT_GE(outer.high, inner.high);
        }
        inner = outer;
      }
    }
  }
}

TEST(WilsonInterval, HasThePublishedMeanCoverageOverTheBinomials) {
  // Summed exactly over the counts, averaged over p: no draws, so nothing is left to chance. The means are the score
  // interval's of [Agresti and Coull 1998], table 1, level 0.95.
  const struct {
    std::uint64_t trials;
    double mean_coverage;
  } rows[] = {{5, 0.955}, {15, 0.953}, {30, 0.952}, {50, 0.952}, {100, 0.951}};
  for (const auto& row : rows) {
    const std::vector<ProportionInterval> intervals = all_intervals(row.trials, 0.95);
    double sum = 0.0;
    constexpr int points = 2000;
    for (int i = 0; i < points; ++i) sum += coverage(intervals, (i + 0.5) / points);
    EXPECT_NEAR(sum / points, row.mean_coverage, 0.5e-3) << "n = " << row.trials;
  }
}

TEST(WilsonInterval, NeverFallsFarBelowItsLevelAwayFromTheEnds) {
  const std::vector<ProportionInterval> intervals = all_intervals(200, 0.95);
  for (double p = 0.05; p <= 0.95; p += 0.0003) EXPECT_GT(coverage(intervals, p), 0.92) << p;
}

TEST(WilsonInterval, RefusesWhatIsNoProportion) {
  EXPECT_THROW(wilson_interval(0, 0, 0.95), std::invalid_argument);
  EXPECT_THROW(wilson_interval(2, 1, 0.95), std::invalid_argument);
  EXPECT_THROW(wilson_interval(1, 2, 0.0), std::invalid_argument);
  EXPECT_THROW(wilson_interval(1, 2, 1.0), std::invalid_argument);
  EXPECT_THROW(wilson_interval(1, 2, std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
}

TEST(ClopperPearsonInterval, IsClosedAtNoneAndAtAllSuccesses) {
  for (const std::uint64_t n : {1ULL, 2ULL, 10ULL, 997ULL, 1000000ULL}) {
    for (const double level : {0.5, 0.95, 0.999}) {
      const double reach = -std::expm1(std::log((1.0 - level) / 2.0) / static_cast<double>(n));
      const ProportionInterval none = clopper_pearson_interval(0, n, level);
      EXPECT_EQ(none.estimate, 0.0);
      EXPECT_EQ(none.low, 0.0);
      EXPECT_NEAR(none.high, reach, 1e-12 * reach);
      const ProportionInterval all = clopper_pearson_interval(n, n, level);
      EXPECT_EQ(all.estimate, 1.0);
      EXPECT_NEAR(all.low, 1.0 - reach, 1e-13);
      EXPECT_EQ(all.high, 1.0);
      EXPECT_EQ(all.level, level);
    }
  }
}

TEST(ClopperPearsonInterval, NeverCoversLessThanItsLevel) {
  for (const std::uint64_t n : {1ULL, 7ULL, 60ULL}) {
    std::vector<ProportionInterval> intervals;
    for (std::uint64_t x = 0; x <= n; ++x) intervals.push_back(clopper_pearson_interval(x, n, 0.95));
    for (double p = 0.0005; p < 1.0; p += 0.001) EXPECT_GE(coverage(intervals, p), 0.95) << n << ' ' << p;
  }
}

TEST(ClopperPearsonInterval, OfVeryManyTrialsIsWilsons) {
  for (const std::uint64_t x : {300'000'000ULL, 999'000'000ULL}) {
    const ProportionInterval exact = clopper_pearson_interval(x, 1'000'000'000, 0.95);
    const ProportionInterval score = wilson_interval(x, 1'000'000'000, 0.95);
    EXPECT_NEAR(exact.low, score.low, 2e-9);
    EXPECT_NEAR(exact.high, score.high, 2e-9);
  }
}

TEST(ClopperPearsonInterval, RefusesWhatIsNoProportion) {
  EXPECT_THROW(clopper_pearson_interval(0, 0, 0.95), std::invalid_argument);
  EXPECT_THROW(clopper_pearson_interval(2, 1, 0.95), std::invalid_argument);
  EXPECT_THROW(clopper_pearson_interval(1, 2, 0.0), std::invalid_argument);
  EXPECT_THROW(clopper_pearson_interval(1, 2, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace steerstat
