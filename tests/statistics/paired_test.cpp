#include "statistics/paired.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "core/normal.hpp"

namespace steerstat {
namespace {

PairedCounts table(std::uint64_t both, std::uint64_t a_only, std::uint64_t b_only, std::uint64_t neither) {
  return {both, a_only, b_only, neither};
}

TEST(McNemarTest, MeetsThePublishedExamples) {
  // [Fagerland 2013], tables of the airway and the consolidation studies: exact conditional and mid-p values.
  const McNemarTest airway = mcnemar_test(table(1, 7, 1, 12));
  EXPECT_NEAR(airway.p_value, 0.0703, 0.5e-4);
  EXPECT_NEAR(airway.mid_p_value, 0.0391, 0.5e-4);
  const McNemarTest consolidation = mcnemar_test(table(59, 16, 6, 80));
  EXPECT_NEAR(consolidation.p_value, 0.0525, 0.5e-4);
  EXPECT_NEAR(consolidation.mid_p_value, 0.034690, 0.5e-6);
}

TEST(McNemarTest, IsOneWherePairsAgreeOrDiscordIsBalancedAndIgnoresTheConcordant) {
  for (const std::uint64_t each : {0U, 1U, 7U, 4000U}) {
    const McNemarTest test = mcnemar_test(table(3, each, each, 5));
    EXPECT_EQ(test.p_value, 1.0);
    EXPECT_EQ(test.mid_p_value, 1.0);
  }
  EXPECT_EQ(mcnemar_test(table(0, 3, 9, 0)).p_value, mcnemar_test(table(1000000, 9, 3, 50)).p_value);
}

TEST(McNemarTest, OneSidedDiscordHalvesWithEveryPair) {
  for (std::uint64_t discordant = 1; discordant <= 60; ++discordant) {
    const McNemarTest test = mcnemar_test(table(5, 0, discordant, 5));
    const double each = std::ldexp(1.0, -static_cast<int>(discordant));
    EXPECT_NEAR(test.p_value, 2.0 * each, 1e-12 * each);
    EXPECT_NEAR(test.mid_p_value, each, 1e-12 * each);
  }
}

TEST(McNemarTest, RejectsATrueHypothesisNoMoreOftenThanItsSize) {
  // Exactly, over every split of the discordant pairs: no draws, so nothing is left to chance.
  for (const std::uint64_t discordant : {1U, 5U, 6U, 20U, 100U}) {
    for (const double size : {0.001, 0.01, 0.05, 0.1}) {
      double rejected = 0.0;
      for (std::uint64_t a = 0; a <= discordant; ++a) {
        if (mcnemar_test(table(0, a, discordant - a, 0)).p_value > size) continue;
        const auto n = static_cast<double>(discordant);
        const auto k = static_cast<double>(a);
        rejected +=
            std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) - n * std::log(2.0));
      }
      EXPECT_LE(rejected, size) << discordant;
    }
  }
}

TEST(TangoInterval, MeetsThePublishedExamples) {
  // [Fagerland 2017], chapter 8, the same two studies; their difference is A less B.
  const DifferenceInterval airway = tango_interval(table(1, 7, 1, 12), 0.95);
  EXPECT_NEAR(airway.low, -0.517, 0.5e-3);
  EXPECT_NEAR(airway.high, -0.026, 0.5e-3);
  const DifferenceInterval consolidation = tango_interval(table(59, 16, 6, 80), 0.95);
  EXPECT_NEAR(consolidation.estimate, -0.0621, 0.5e-4);
  EXPECT_NEAR(consolidation.low, -0.1240, 0.5e-4);
  EXPECT_NEAR(consolidation.high, -0.0054, 0.5e-4);
}

TEST(TangoInterval, WithoutDiscordIsTheScoreIntervalAtNoSuccesses) {
  for (const std::uint64_t n : {1ULL, 10ULL, 2000ULL, 1000000000ULL}) {
    const DifferenceInterval interval = tango_interval(table(n - 1, 0, 0, 1), 0.95);
    const double z = normal_quantile(0.975);
    const double reach = z * z / (static_cast<double>(n) + z * z);
    EXPECT_EQ(interval.estimate, 0.0);
    EXPECT_NEAR(interval.high, reach, 1e-12 * reach);
    EXPECT_NEAR(interval.low, -reach, 1e-12 * reach);
  }
}

TEST(TangoInterval, IsClosedWhereEveryPairIsDiscordantOneWay) {
  EXPECT_EQ(tango_interval(table(0, 0, 12, 0), 0.95).high, 1.0);
  EXPECT_LT(tango_interval(table(0, 0, 12, 0), 0.95).low, 1.0);
  EXPECT_EQ(tango_interval(table(0, 12, 0, 0), 0.95).low, -1.0);
  EXPECT_LT(tango_interval(table(1, 0, 12, 0), 0.95).high, 1.0);
}

TEST(TangoInterval, MirrorsWhenAAndBSwapAndHoldsItsEstimate) {
  for (std::uint64_t a = 0; a <= 20; ++a) {
    for (std::uint64_t b = 0; a + b <= 20; ++b) {
      const DifferenceInterval one = tango_interval(table(4, a, b, 20 - a - b), 0.9);
      const DifferenceInterval other = tango_interval(table(4, b, a, 20 - a - b), 0.9);
      EXPECT_EQ(one.low, -other.high);
      EXPECT_EQ(one.high, -other.low);
      EXPECT_LE(-1.0, one.low);
      EXPECT_LT(one.low, one.estimate);
      EXPECT_LT(one.estimate, one.high);
      EXPECT_LE(one.high, 1.0);
      const DifferenceInterval wider = tango_interval(table(4, a, b, 20 - a - b), 0.99);
      EXPECT_LT(wider.low, one.low);
      EXPECT_GT(wider.high, one.high);
    }
  }
}

/// Every table of `n` pairs by its discordant counts, with its interval.
struct Enumerated {
  std::uint64_t a_only, b_only;
  DifferenceInterval interval;
};

std::vector<Enumerated> all_tables(std::uint64_t n) {
  std::vector<Enumerated> tables;
  for (std::uint64_t a = 0; a <= n; ++a) {
    for (std::uint64_t b = 0; a + b <= n; ++b) {
      tables.push_back({a, b, tango_interval(table(n - a - b, a, b, 0), 0.95)});
    }
  }
  return tables;
}

/// Probability that the interval covers p_b - p_a where the discordant cells have the probabilities p_a and p_b; summed
/// over all tables.
double coverage(const std::vector<Enumerated>& tables, std::uint64_t pairs, double p_a, double p_b) {
  const auto n = static_cast<double>(pairs);
  double covered = 0.0;
  for (const Enumerated& t : tables) {
    if (p_b - p_a < t.interval.low || p_b - p_a > t.interval.high) continue;
    const auto a = static_cast<double>(t.a_only);
    const auto b = static_cast<double>(t.b_only);
    const double rest = n - a - b;
    covered += std::exp(std::lgamma(n + 1.0) - std::lgamma(a + 1.0) - std::lgamma(b + 1.0) - std::lgamma(rest + 1.0) +
                        a * std::log(p_a) + b * std::log(p_b) + rest * std::log1p(-p_a - p_b));
  }
  return covered;
}

TEST(TangoInterval, CoversAtItsLevelOverTheTrinomials) {
  constexpr std::uint64_t pairs = 40;
  const std::vector<Enumerated> tables = all_tables(pairs);
  double sum = 0.0;
  double least = 1.0;
  int points = 0;
  for (double p_a = 0.01; p_a < 0.6; p_a += 0.04) {
    for (double p_b = 0.013; p_a + p_b < 0.99; p_b += 0.04) {
      const double covered = coverage(tables, pairs, p_a, p_b);
      sum += covered;
      least = std::min(least, covered);
      ++points;
    }
  }
  EXPECT_NEAR(sum / points, 0.95, 0.005);
  EXPECT_GT(least, 0.92);
}

TEST(TangoInterval, CoversWhereDiscordIsRare) {
  // Most tables then have no or one discordant pair, where a Wald interval has no width.
  constexpr std::uint64_t pairs = 40;
  const std::vector<Enumerated> tables = all_tables(pairs);
  for (const double p_a : {1e-6, 1e-4, 1e-3, 5e-3}) {
    for (const double p_b : {1e-6, 1e-4, 1e-3, 5e-3}) {
      EXPECT_GT(coverage(tables, pairs, p_a, p_b), 0.94) << p_a << " and " << p_b;
    }
  }
}

TEST(TangoInterval, RefusesWhatIsNoTable) {
  EXPECT_THROW(tango_interval({}, 0.95), std::invalid_argument);
  EXPECT_THROW(tango_interval(table(1, 0, 0, 0), 0.0), std::invalid_argument);
  EXPECT_THROW(tango_interval(table(1, 0, 0, 0), 1.0), std::invalid_argument);
  EXPECT_THROW(tango_interval(table(1, 0, 0, 0), std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
}

TEST(HolmAdjusted, MultipliesByTheHypothesesLeftAndNeverFalls) {
  const std::vector<double> p{0.04, 0.01, 0.03, 0.005};
  const std::vector<double> adjusted = holm_adjusted(p);
  const std::array<double, 4> expected{0.06, 0.03, 0.06, 0.02};
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_NEAR(adjusted[i], expected[i], 1e-15);
  EXPECT_EQ(holm_adjusted(std::vector<double>{0.3}), std::vector<double>{0.3});
  EXPECT_EQ(holm_adjusted(std::vector<double>{0.6, 0.7}), (std::vector<double>{1.0, 1.0}));
  EXPECT_TRUE(holm_adjusted({}).empty());
}

}  // namespace
}  // namespace steerstat
