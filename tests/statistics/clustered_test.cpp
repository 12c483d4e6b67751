#include "statistics/clustered.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "statistics/confidence_sequence.hpp"
#include "statistics/sample.hpp"

namespace steerstat {
namespace {

constexpr double cluster_level = 0.95;

std::vector<ClusterSum> singles(std::uint64_t successes, std::uint64_t trials) {
  std::vector<ClusterSum> clusters(trials, {1, 0.0});
  for (std::uint64_t i = 0; i < successes; ++i) clusters[i].total = 1.0;
  return clusters;
}

TEST(EffectiveTrials, OfClustersOfOneAreTheTrials) {
  // But for the divisor n - 1 of the variance.
  EXPECT_NEAR(effective_trials(singles(30, 100), cluster_level), 99.0, 1e-9);
  EXPECT_EQ(effective_trials(singles(0, 100), cluster_level), 100.0);
  EXPECT_EQ(effective_trials(singles(100, 100), cluster_level), 100.0);
}

TEST(EffectiveTrials, OfClustersThatAgreeAreTheClusters) {
  std::vector<ClusterSum> clusters;
  for (int i = 0; i < 50; ++i) clusters.push_back({8, i < 20 ? 8.0 : 0.0});
  // Less a little for the variance being estimated from 50: by the 97.5 % quantiles of t with 399 and 49 degrees.
  EXPECT_NEAR(effective_trials(clusters, cluster_level), 49.0 * std::pow(1.965927 / 2.009575, 2), 1e-4);
  for (ClusterSum& cluster : clusters) cluster.total = 8.0;
  EXPECT_EQ(effective_trials(clusters, cluster_level), 50.0)
      << "nothing shows that their trials do not all say the same";
  for (ClusterSum& cluster : clusters) cluster.total = 0.0;
  EXPECT_EQ(effective_trials(clusters, cluster_level), 50.0);
}

TEST(EffectiveTrials, AreNeverMoreThanTheTrialsAndFewForFewClusters) {
  // Each cluster succeeds in exactly half of its trials: no variance at all.
  EXPECT_NEAR(effective_trials(std::vector<ClusterSum>(200, {2, 1.0}), cluster_level), 400.0, 8.0);
  EXPECT_LT(effective_trials(std::vector<ClusterSum>(2, {2, 1.0}), cluster_level), 1.0 + 1e-12);
  EXPECT_EQ(effective_trials(std::vector<ClusterSum>{{10, 7.0}}, cluster_level), 1.0);
  EXPECT_EQ(effective_trials({}, cluster_level), 0.0);
  EXPECT_EQ(effective_trials(std::vector<ClusterSum>(3, {0, 0.0}), cluster_level), 0.0);
}

TEST(ClusteredProportion, NeedsATrial) {
  EXPECT_THROW(clustered_proportion(ProportionMethod::wilson, {}, cluster_level), std::invalid_argument);
  EXPECT_THROW(clustered_proportion(ProportionMethod::wilson, singles(1, 3), 1.0), std::invalid_argument);
}

TEST(ClusteredProportion, OfConfidenceSequencesCountsClusters) {
  std::vector<ClusterSum> clusters;
  for (int i = 0; i < 50; ++i) clusters.push_back({4, i < 20 ? 4.0 : 0.0});
  const ProportionInterval whole = confidence_sequence(20, 50, cluster_level);
  const ProportionInterval ours = clustered_proportion(ProportionMethod::confidence_sequence, clusters, cluster_level);
  EXPECT_EQ(ours.low, whole.low);
  EXPECT_EQ(ours.high, whole.high);
  clusters[20].total = 1.0;  // 20.25 of 50: rounded outwards
  const ProportionInterval wider = clustered_proportion(ProportionMethod::confidence_sequence, clusters, cluster_level);
  EXPECT_EQ(wider.low, whole.low);
  EXPECT_EQ(wider.high, confidence_sequence(21, 50, cluster_level).high);
}

/// Draws of which each has a chance of its own, shared by its trials in every cell.
struct ClusteredDraws {
  std::vector<ClusterSum> successes;
  std::vector<ClusterSum> values;
  std::vector<std::vector<double>> by_draw;
  std::uint64_t converged{0};
};

ClusteredDraws clustered_draws(std::mt19937_64& generator, std::size_t draws, std::size_t cells) {
  const auto uniform = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
  ClusteredDraws result;
  for (std::size_t i = 0; i < draws; ++i) {
    const double ease = uniform();
    ClusterSum successes{cells, 0.0};
    ClusterSum values{0, 0.0};
    result.by_draw.emplace_back();
    for (std::size_t cell = 0; cell < cells; ++cell) {
      // A trial succeeds by its draw mostly; the harder ones take longer.
      if (0.8 * ease + 0.2 * uniform() < 0.3) continue;
      successes.total += 1.0;
      const double value = 1.0 / (0.1 + ease) + uniform();
      result.by_draw.back().push_back(value);
      ++values.count;
      values.total += value;
    }
    result.converged += static_cast<std::uint64_t>(successes.total);
    result.successes.push_back(successes);
    result.values.push_back(values);
  }
  return result;
}

std::vector<ClusterSum> at_or_below(const ClusteredDraws& draws, double x) {
  std::vector<ClusterSum> clusters;
  for (const std::vector<double>& values : draws.by_draw) {
    const auto below = std::count_if(values.begin(), values.end(), [&](double value) { return value <= x; });
    clusters.push_back({values.size(), static_cast<double>(below)});
  }
  return clusters;
}

/// The claim that matters: the level holds where trials share draws, where intervals of independent trials miss
/// it.
TEST(ClusteredIntervals, CoverWhatTheyClaimWhereIntervalsOfIndependentTrialsDoNot) {
  constexpr std::size_t cells = 6;
  std::mt19937_64 generator(5);
  const ClusteredDraws population = clustered_draws(generator, 400'000, cells);
  std::vector<double> all;
  for (const auto& values : population.by_draw) all.insert(all.end(), values.begin(), values.end());
  std::sort(all.begin(), all.end());
  const double rate = static_cast<double>(population.converged) / (400'000.0 * cells);
  const double mean = describe(all)->mean;
  const double p90 = quantile(all, 0.9);

  constexpr int studies = 1500;
  int rates = 0, naive_rates = 0, means = 0, naive_means = 0, quantiles = 0, naive_quantiles = 0, sequences = 0,
      rank_sequences = 0;
  for (int i = 0; i < studies; ++i) {
    const ClusteredDraws draws = clustered_draws(generator, 80, cells);
    const auto covers = [](const auto& interval, double truth) {
      return interval.low <= truth && truth <= interval.high ? 1 : 0;
    };
    const auto holds = [](const SampleInterval& interval, double truth) {
      return (!interval.low || *interval.low <= truth) && (!interval.high || truth <= *interval.high) ? 1 : 0;
    };
    rates += covers(clustered_proportion(ProportionMethod::wilson, draws.successes, cluster_level), rate);
    sequences +=
        covers(clustered_proportion(ProportionMethod::confidence_sequence, draws.successes, cluster_level), rate);
    naive_rates += covers(wilson_interval(draws.converged, 80 * cells, cluster_level), rate);
    means += holds(clustered_mean(draws.values, cluster_level), mean);
    std::vector<double> sorted;
    for (const auto& values : draws.by_draw) sorted.insert(sorted.end(), values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    const SampleStatistics sample = *describe(sorted);
    naive_means += holds(mean_interval(sample.mean, sample.std, sample.count, cluster_level), mean);
    const auto clusters = at_or_below(draws, quantile(sorted, 0.9));
    quantiles += holds(between(sorted, clustered_quantile_ranks(clusters, 0.9, cluster_level)), p90);
    rank_sequences +=
        holds(between(sorted, clustered_confidence_sequence_ranks(clusters, cells, 0.9, cluster_level)), p90);
    naive_quantiles += holds(quantile_interval(sorted, 0.9, cluster_level), p90);
  }
  const double error = 3.0 * std::sqrt(0.05 * 0.95 / studies);
  const auto share = [](int covered) { return static_cast<double>(covered) / studies; };
  EXPECT_GT(share(rates), 0.95 - error);
  EXPECT_GT(share(means), 0.95 - error - 0.01) << "Student's t is approximate for skewed values";
  EXPECT_GT(share(quantiles), 0.95 - error);
  EXPECT_GT(share(sequences), 0.95 - error);
  EXPECT_GT(share(rank_sequences), 0.95 - error);
  EXPECT_LT(share(naive_rates), 0.85);
  EXPECT_LT(share(naive_means), 0.85);
  EXPECT_LT(share(naive_quantiles), 0.85);
  RecordProperty("rates", std::to_string(share(rates)));
  RecordProperty("means", std::to_string(share(means)));
  RecordProperty("quantiles", std::to_string(share(quantiles)));
}

TEST(ClusteredConfidenceSequenceRanks, OfClustersOfOneAreThoseOfTrials) {
  for (const std::uint64_t n : {50U, 400U}) {
    for (const double p : {0.05, 0.5, 0.95}) {
      EXPECT_EQ(clustered_confidence_sequence_ranks(singles(0, n), 1, p, cluster_level),
                confidence_sequence_ranks(n, p, cluster_level));
    }
  }
}

TEST(ClusteredMean, IsThatOfTheClustersWhereTheyHaveOneSize) {
  const std::vector<ClusterSum> clusters{{2, 6.0}, {2, 10.0}, {2, 2.0}, {2, 8.0}};
  const std::vector<double> means{3.0, 5.0, 1.0, 4.0};
  const SampleStatistics sample = *describe(means);
  const SampleInterval expected = mean_interval(sample.mean, sample.std, 4, cluster_level);
  EXPECT_NEAR(*clustered_mean(clusters, cluster_level).low, *expected.low, 1e-12);
  EXPECT_NEAR(*clustered_mean(clusters, cluster_level).high, *expected.high, 1e-12);
  EXPECT_EQ(clustered_mean(std::vector<ClusterSum>{{5, 3.0}}, cluster_level), SampleInterval{});
  EXPECT_EQ(clustered_mean(std::vector<ClusterSum>{{5, 3.0}, {0, 0.0}}, cluster_level), SampleInterval{});
}

TEST(Stretched, RanksAreScaledAwayFromTheQuantile) {
  EXPECT_EQ(stretched({3, 8}, 10.0, 10), (QuantileRanks{3, 8}));
  EXPECT_EQ(stretched({3, 8}, 10.0, 25), (QuantileRanks{7, 20}));
  EXPECT_EQ(stretched({std::nullopt, std::nullopt}, 10.0, 25), QuantileRanks{});
}

}  // namespace
}  // namespace steerstat
