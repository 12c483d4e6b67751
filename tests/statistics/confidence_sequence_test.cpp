#include "statistics/confidence_sequence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "core/normal.hpp"

namespace steerstat {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(LogMixtureRatio, IsThatOfPredictingEachTrialFromThoseBefore) {
  // The mixture predicts a success after s of n trials with probability (s + 1/2) / (n + 1).
  std::mt19937_64 generator(21);
  for (const double p : {1e-3, 0.3, 0.5, 0.99}) {
    std::bernoulli_distribution trial(p);
    std::uint64_t successes = 0;
    double expected = 0.0;
    for (std::uint64_t n = 0; n < 3000; ++n) {
      ASSERT_NEAR(log_mixture_ratio(successes, n, p), expected, 1e-10) << successes << " of " << n << ", p " << p;
      const bool success = trial(generator);
      const auto seen = static_cast<double>(success ? successes : n - successes);
      expected += std::log((seen + 0.5) / (static_cast<double>(n) + 1.0) / (success ? p : 1.0 - p));
      successes += success ? 1U : 0U;
    }
  }
}

TEST(LogMixtureRatio, HasMeanOneAtTheTrueProportion) {
  for (const std::uint64_t n : {1ULL, 5ULL, 60ULL}) {
    for (const double p : {1e-3, 0.5, 0.99}) {
      double mean = 0.0;
      const auto trials = static_cast<double>(n);
      for (std::uint64_t x = 0; x <= n; ++x) {
        const auto k = static_cast<double>(x);
        mean += std::exp(std::lgamma(trials + 1.0) - std::lgamma(k + 1.0) - std::lgamma(trials - k + 1.0) +
                         k * std::log(p) + (trials - k) * std::log1p(-p) + log_mixture_ratio(x, n, p));
      }
      EXPECT_NEAR(mean, 1.0, 1e-11) << n << ' ' << p;
    }
  }
}

TEST(LogMixtureRatio, IsInfiniteWhereTheProportionIsImpossible) {
  EXPECT_EQ(log_mixture_ratio(1, 3, 0.0), infinity);
  EXPECT_EQ(log_mixture_ratio(2, 3, 1.0), infinity);
  EXPECT_LT(log_mixture_ratio(0, 3, 0.0), 0.0);
  EXPECT_LT(log_mixture_ratio(3, 3, 1.0), 0.0);
  EXPECT_EQ(log_mixture_ratio(0, 0, 0.0), 0.0);
}

TEST(ConfidenceSequence, IsEveryProportionWhoseRatioIsBelowTheThreshold) {
  for (const std::uint64_t n : {1ULL, 2ULL, 30ULL, 1000ULL, 1'000'000'000ULL}) {
    for (const double level : {0.5, 0.95, 0.9999}) {
      for (const std::uint64_t x : {std::uint64_t{0}, n / 3, n - 1, n}) {
        const ProportionInterval interval = confidence_sequence(x, n, level);
        const double threshold = -std::log(1.0 - level);
        EXPECT_EQ(interval.estimate, static_cast<double>(x) / static_cast<double>(n));
        EXPECT_EQ(interval.level, level);
        if (x == 0) {
          EXPECT_EQ(interval.low, 0.0);
        } else {
          EXPECT_GE(log_mixture_ratio(x, n, interval.low), threshold * (1.0 - 1e-12));
          EXPECT_LT(log_mixture_ratio(x, n, std::nextafter(interval.low, 1.0)), threshold * (1.0 + 1e-12));
        }
        if (x == n) {
          EXPECT_EQ(interval.high, 1.0);
        } else {
          EXPECT_GE(log_mixture_ratio(x, n, interval.high), threshold * (1.0 - 1e-12));
          EXPECT_LT(log_mixture_ratio(x, n, std::nextafter(interval.high, 0.0)), threshold * (1.0 + 1e-12));
        }
      }
    }
  }
}

TEST(ConfidenceSequence, IsAboutTwiceAsWideAsWilsonsIntervalAtTenThousandTrials) {
  for (const std::uint64_t x : {5000ULL, 9000ULL, 9990ULL}) {
    const ProportionInterval sequence = confidence_sequence(x, 10'000, 0.95);
    const ProportionInterval wilson = wilson_interval(x, 10'000, 0.95);
    EXPECT_LT(sequence.low, wilson.low);
    EXPECT_GT(sequence.high, wilson.high);
    EXPECT_NEAR((sequence.high - sequence.low) / (wilson.high - wilson.low), 2.0, 0.1) << x;
  }
}

TEST(ConfidenceSequence, RefusesWhatIsNoProportion) {
  EXPECT_THROW(confidence_sequence(0, 0, 0.95), std::invalid_argument);
  EXPECT_THROW(confidence_sequence(2, 1, 0.95), std::invalid_argument);
  for (const double bad : {0.0, 1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(confidence_sequence(1, 2, bad), std::invalid_argument);
    EXPECT_THROW(confidence_sequence_ranks(10, 0.5, bad), std::invalid_argument);
    EXPECT_THROW(confidence_sequence_ranks(10, bad, 0.95), std::invalid_argument);
  }
}

/// Bernoulli streams, looked at after every trial up to a horizon.
class WatchedAfterEveryTrial : public testing::TestWithParam<double> {
 protected:
  static constexpr int streams = 2000;
  static constexpr std::uint64_t horizon = 2000;
  static constexpr double alpha = 0.05;

  /// In how many of the streams `misses(successes, n)` at any n. A Bernoulli count's standard error is at most
  /// sqrt(streams alpha (1 - alpha)) where it is at most alpha.
  template <class Misses>
  static int streams_missed(double p, const Misses& misses) {
    std::mt19937_64 generator(22);
    std::bernoulli_distribution trial(p);
    int missed = 0;
    for (int stream = 0; stream < streams; ++stream) {
      std::uint64_t successes = 0;
      bool miss = false;
      for (std::uint64_t n = 1; n <= horizon && !miss; ++n) {
        successes += trial(generator) ? 1U : 0U;
        miss = misses(successes, n);
      }
      missed += miss ? 1 : 0;
    }
    return missed;
  }

  static double most_allowed() { return streams * alpha + 3.0 * std::sqrt(streams * alpha * (1.0 - alpha)); }
};

TEST_P(WatchedAfterEveryTrial, TheSequenceMissesTheProportionNoMoreOftenThanItsLevelSays) {
  const double p = GetParam();
  // The counts at which it misses, once per n, not once per stream: p is outside the interval where its ratio reaches
  // the threshold, and the ratio falls and rises with the count.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> covering(horizon + 1);
  for (std::uint64_t n = 1; n <= horizon; ++n) {
    const auto covers = [&](std::uint64_t x) { return log_mixture_ratio(x, n, p) < -std::log(alpha); };
    auto& [fewest, most] = covering[n];
    fewest = std::min(n, static_cast<std::uint64_t>(std::max(0.0, std::ceil(static_cast<double>(n) * p - 0.5))));
    most = fewest;
    ASSERT_TRUE(covers(fewest));
    while (fewest > 0 && covers(fewest - 1)) --fewest;
    while (most < n && covers(most + 1)) ++most;
  }
  const int missed = streams_missed(
      p, [&](std::uint64_t x, std::uint64_t n) { return x < covering[n].first || x > covering[n].second; });
  EXPECT_LE(missed, most_allowed());
  EXPECT_EQ(missed > 0, p > 0.0 && p < 1.0) << "the sequence is not so wide as never to miss";
}

TEST_P(WatchedAfterEveryTrial, WilsonsIntervalMissesFarMoreOftenThanItsLevelSays) {
  const double p = GetParam();
  const double z = -normal_quantile(alpha / 2.0);
  // Wilson's interval leaves out the p whose score is beyond z (WilsonInterval.LimitsAreWhereTheScoreTestJustRejects).
  const int missed = streams_missed(p, [&](std::uint64_t x, std::uint64_t n) {
    const auto trials = static_cast<double>(n);
    return std::abs(static_cast<double>(x) - trials * p) > z * std::sqrt(trials * p * (1.0 - p));
  });
  if (p == 0.0 || p == 1.0) {
    EXPECT_EQ(missed, 0) << "nothing varies, so nothing misses";
  } else {
    EXPECT_GT(missed, 5.0 * streams * alpha);
  }
}

INSTANTIATE_TEST_SUITE_P(Proportions, WatchedAfterEveryTrial, testing::Values(0.0, 1e-3, 0.5, 0.99, 1.0));

TEST(ConfidenceSequence, AndItsRanksAreTwoSidesOfOneTest) {
  for (const std::uint64_t n : {1ULL, 13ULL, 250ULL}) {
    for (const double p : {0.05, 0.5, 0.95}) {
      const QuantileRanks ranks = confidence_sequence_ranks(n, p, 0.9);
      for (std::uint64_t x = 0; x <= n; ++x) {
        const ProportionInterval interval = confidence_sequence(x, n, 0.9);
        const bool covers = interval.low <= p && p <= interval.high;
        EXPECT_EQ(covers, x >= ranks.low.value_or(0) && x < ranks.high.value_or(n + 1)) << x << " of " << n;
      }
    }
  }
}

TEST(ConfidenceSequenceRanks, OfNoValueAndOfFewBoundNothing) {
  EXPECT_EQ(confidence_sequence_ranks(0, 0.95, 0.95), QuantileRanks{});
  EXPECT_EQ(confidence_sequence_ranks(1, 0.95, 0.95), QuantileRanks{});
  EXPECT_EQ(confidence_sequence_ranks(1, 0.5, 0.95), QuantileRanks{});
  EXPECT_FALSE(confidence_sequence_ranks(100, 0.99, 0.95).high);
  EXPECT_TRUE(confidence_sequence_ranks(100, 0.99, 0.95).low);
  EXPECT_TRUE(confidence_sequence_ranks(2000, 0.99, 0.95).high);
}

TEST(ConfidenceSequenceRanks, LieOutsideThoseOfAFixedSampleSize) {
  for (const std::uint64_t n : {100ULL, 5000ULL, 1'000'000ULL}) {
    const QuantileRanks uniform = confidence_sequence_ranks(n, 0.9, 0.95);
    const QuantileRanks fixed = quantile_ranks(n, 0.9, 0.95);
    ASSERT_TRUE(uniform.low && uniform.high && fixed.low && fixed.high);
    EXPECT_LT(*uniform.low, *fixed.low);
    EXPECT_GT(*uniform.high, *fixed.high);
  }
}

/// In how many samples, looked at after every tenth value, the order statistics at `ranks_of(n)` ever miss `truth`.
template <class RanksOf>
int samples_missed(bool tied, int samples, double truth, const RanksOf& ranks_of) {
  constexpr std::size_t looks = 60;
  std::array<QuantileRanks, looks> ranks;
  for (std::size_t look = 0; look < looks; ++look) ranks[look] = ranks_of(10 * (look + 1));
  std::mt19937_64 generator(23);
  std::exponential_distribution<double> waits(1.0);
  int missed = 0;
  for (int sample = 0; sample < samples; ++sample) {
    std::vector<double> sorted;
    bool miss = false;
    for (std::size_t look = 0; look < looks && !miss; ++look) {
      for (int i = 0; i < 10; ++i) {
        const double x = tied ? std::ceil(4.0 * waits(generator)) / 4.0 : waits(generator);
        sorted.insert(std::upper_bound(sorted.begin(), sorted.end(), x), x);
      }
      const SampleInterval found = between(sorted, ranks[look]);
      miss = found.low.value_or(-infinity) > truth || found.high.value_or(infinity) < truth;
    }
    missed += miss ? 1 : 0;
  }
  return missed;
}

TEST(ConfidenceSequenceRanks, HoldAtAllSampleSizesTiesIncludedWhereThoseOfAFixedSizeDoNot) {
  constexpr double p = 0.8;
  constexpr double alpha = 0.1;
  constexpr int samples = 500;
  const double error = std::sqrt(samples * alpha * (1.0 - alpha));
  const double quantile = -std::log(1.0 - p);
  const auto uniform = [&](std::uint64_t n) { return confidence_sequence_ranks(n, p, 1.0 - alpha); };
  const auto fixed = [&](std::uint64_t n) { return quantile_ranks(n, p, 1.0 - alpha); };
  const int missed = samples_missed(false, samples, quantile, uniform);
  EXPECT_GT(missed, 0);
  EXPECT_LE(missed, samples * alpha + 3.0 * error);
  // Rounded up to quarters, the values tie at their quantile, which is the true one rounded up.
  EXPECT_LE(samples_missed(true, samples, std::ceil(4.0 * quantile) / 4.0, uniform), samples * alpha + 3.0 * error);
  EXPECT_GT(samples_missed(false, samples, quantile, fixed), samples * alpha + 6.0 * error);
}

TEST(QuantileConfidenceSequence, ReadsItsBoundsOffTheOrderStatistics) {
  std::vector<double> sorted(500);
  for (std::size_t i = 0; i < sorted.size(); ++i) sorted[i] = 100.0 + static_cast<double>(i + 1);
  const QuantileRanks ranks = confidence_sequence_ranks(500, 0.5, 0.95);
  const SampleInterval interval = quantile_confidence_sequence(sorted, 0.5, 0.95);
  EXPECT_EQ(interval.low.value(), 100.0 + static_cast<double>(ranks.low.value()));
  EXPECT_EQ(interval.high.value(), 100.0 + static_cast<double>(ranks.high.value()));
  EXPECT_EQ(quantile_confidence_sequence({}, 0.5, 0.95), SampleInterval{});
}

}  // namespace
}  // namespace steerstat
