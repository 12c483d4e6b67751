#pragma once

#include <cstdint>
#include <span>

#include "statistics/proportion.hpp"
#include "statistics/sample_interval.hpp"

/// Intervals of statistics over trials that come in clusters, such as those of one draw in all cells of a sweep. Trials
/// of a cluster go together, clusters are independent: it is their number that tells how much is known.
namespace steerstat {

/// What a cluster adds to a ratio of sums, total / count.
struct ClusterSum {
  std::uint64_t count;  ///< its trials that have the value
  double total;         ///< of their values; of a proportion, the number of successes
};

/// Clusters of the same number of trials each, as sums: what they say of a proportion, without a list of them.
struct EqualClusters {
  std::uint64_t clusters{0};
  std::uint64_t size{1};       ///< trials in each; sums of squares fit where size^2 x clusters is below 2^63
  std::uint64_t successes{0};  ///< in all
  std::uint64_t squares{0};    ///< sum of the squares of each cluster's successes
};

/// How many independent trials tell as much of a proportion as these clusters do: p (1 - p) over the variance of the
/// ratio between clusters (linearised), lessened for that variance being estimated from few clusters
/// [Korn and Graubard 1998]. Where every trial succeeds, or none, the trials of a cluster might all say the same: then
/// it is the number of clusters that have any.
///
/// @param clusters  (clusters) with successes as totals
/// @param level     in (0, 1)
/// @return from 0, without trials, to the number of trials
double effective_trials(std::span<const ClusterSum> clusters, double level);
double effective_trials_of_equal(const EqualClusters& clusters, double level);

/// A proportion's interval by the method asked for. Wilson's and Clopper and Pearson's are those of effective_trials().
/// A confidence sequence is of as many trials as there are clusters, each a success by the share of its own, rounded
/// outwards: a share x in [0, 1] has exp(s x) <= 1 - x + x exp(s), so that the mixture which bounds a Bernoulli
/// sequence bounds theirs too, at all times.
///
/// @param clusters  (clusters) with successes as totals, at least one trial in all
/// @throws std::invalid_argument without trials, or for a level outside (0, 1)
ProportionInterval clustered_proportion(ProportionMethod method, std::span<const ClusterSum> clusters, double level);
ProportionInterval equal_clusters_proportion(ProportionMethod method, const EqualClusters& clusters, double level);

/// The interval of the mean of all trials' values, by Student's t from the variance of the ratio between clusters; no
/// bounds with fewer than two clusters that have values.
///
/// @param level  in (0, 1)
/// @throws std::invalid_argument for a level outside that range
SampleInterval clustered_mean(std::span<const ClusterSum> clusters, double level);

/// The ranks that bound the p-quantile of all trials' values [Woodruff 1952]: those of a sample of effective_trials(),
/// stretched to the sample at hand, away from the quantile.
///
/// @param clusters  (clusters) with the number of values at or below the sample's p-quantile as totals
QuantileRanks clustered_quantile_ranks(std::span<const ClusterSum> clusters, double p, double level);

/// The same at all times: the confidence sequence of as many trials as there are clusters, as above.
///
/// @param largest  trials in a cluster at most
QuantileRanks clustered_confidence_sequence_ranks(std::span<const ClusterSum> clusters, std::uint64_t largest, double p,
                                                  double level);

/// Ranks in a sample of n effective trials, as ranks in one of `size`, stretched away from the quantile.
QuantileRanks stretched(const QuantileRanks& ranks, double n, std::uint64_t size);

}  // namespace steerstat
