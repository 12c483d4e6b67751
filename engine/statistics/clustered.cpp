#include "statistics/clustered.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "statistics/confidence_sequence.hpp"

namespace steerstat {
namespace {

struct Sums {
  std::uint64_t count{0};
  double total{0.0};
  std::uint64_t occupied{0};  // clusters that have trials
};

Sums sums_of(std::span<const ClusterSum> clusters) {
  Sums sums;
  for (const ClusterSum& cluster : clusters) {
    sums.count += cluster.count;
    sums.total += cluster.total;
    sums.occupied += cluster.count > 0 ? 1U : 0U;
  }
  return sums;
}

/// The variance of total / count, linearised: clusters are the units. Nothing with fewer than two that have trials.
std::optional<double> ratio_variance(std::span<const ClusterSum> clusters, const Sums& sums) {
  if (sums.occupied < 2) return std::nullopt;
  const auto n = static_cast<double>(clusters.size());
  const auto count = static_cast<double>(sums.count);
  const double ratio = sums.total / count;
  double squares = 0.0;
  for (const ClusterSum& cluster : clusters) {
    const double residual = cluster.total - ratio * static_cast<double>(cluster.count);
    squares += residual * residual;
  }
  return n / (n - 1.0) * squares / (count * count);
}

Sums sums_of(const EqualClusters& clusters) {
  return {clusters.clusters * clusters.size, static_cast<double>(clusters.successes), clusters.clusters};
}

/// The same of clusters of one size: with n clusters, the sum of the squared residuals is that of the squares less the
/// square of the sum over n. In whole numbers, which nothing cancels in.
std::optional<double> ratio_variance(const EqualClusters& clusters, const Sums& sums) {
  if (sums.occupied < 2) return std::nullopt;
  __extension__ using Wide = unsigned __int128;
  const Wide scaled = Wide{clusters.clusters} * clusters.squares - Wide{clusters.successes} * clusters.successes;
  const auto n = static_cast<double>(clusters.clusters);
  const auto count = static_cast<double>(sums.count);
  return static_cast<double>(scaled) / (n - 1.0) / (count * count);
}

/// @throws std::invalid_argument for a level outside (0, 1)
double student_quantile(double degrees, double level) {
  if (!(level > 0.0 && level < 1.0)) throw std::invalid_argument("clustered: needs a level in (0, 1)");
  const boost::math::students_t_distribution<double> student(degrees);
  return boost::math::quantile(boost::math::complement(student, (1.0 - level) / 2.0));
}

template <class Clusters>
double effective_trials_of(const Clusters& clusters, double level) {
  const Sums sums = sums_of(clusters);
  const auto trials = static_cast<double>(sums.count);
  if (sums.count == 0) return 0.0;
  const auto occupied = static_cast<double>(sums.occupied);
  const double p = sums.total / trials;
  const std::optional<double> variance = ratio_variance(clusters, sums);
  if (!variance) return 1.0;
  if (sums.total == 0.0 || sums.total == trials) return occupied;
  const double n = *variance > 0.0 ? std::min(trials, p * (1.0 - p) / *variance) : trials;
  const double few = student_quantile(trials - 1.0, level) / student_quantile(occupied - 1.0, level);
  return std::max(1.0, n * few * few);
}

template <class Clusters>
ProportionInterval proportion_of(ProportionMethod method, const Clusters& clusters, double level) {
  const Sums sums = sums_of(clusters);
  if (sums.count == 0) throw std::invalid_argument("clustered_proportion: needs a trial");
  const double p = sums.total / static_cast<double>(sums.count);
  if (method != ProportionMethod::confidence_sequence) {
    return proportion_interval_of_share(method, p, effective_trials_of(clusters, level), level);
  }
  const auto n = static_cast<double>(sums.occupied);
  const auto fewest = static_cast<std::uint64_t>(std::floor(p * n));
  const auto most = static_cast<std::uint64_t>(std::min(n, std::ceil(p * n)));
  return {p, confidence_sequence(fewest, sums.occupied, level).low,
          confidence_sequence(most, sums.occupied, level).high, level};
}

}  // namespace

double effective_trials(std::span<const ClusterSum> clusters, double level) {
  return effective_trials_of(clusters, level);
}

double effective_trials_of_equal(const EqualClusters& clusters, double level) {
  return effective_trials_of(clusters, level);
}

ProportionInterval clustered_proportion(ProportionMethod method, std::span<const ClusterSum> clusters, double level) {
  return proportion_of(method, clusters, level);
}

ProportionInterval equal_clusters_proportion(ProportionMethod method, const EqualClusters& clusters, double level) {
  return proportion_of(method, clusters, level);
}

SampleInterval clustered_mean(std::span<const ClusterSum> clusters, double level) {
  const Sums sums = sums_of(clusters);
  const std::optional<double> variance = ratio_variance(clusters, sums);
  if (!variance) return {};
  const double mean = sums.total / static_cast<double>(sums.count);
  const double reach = student_quantile(static_cast<double>(sums.occupied - 1), level) * std::sqrt(*variance);
  return {mean - reach, mean + reach};
}

QuantileRanks stretched(const QuantileRanks& ranks, double n, std::uint64_t size) {
  const double scale = static_cast<double>(size) / n;
  QuantileRanks wide;
  if (ranks.low) {
    const double low = std::floor(static_cast<double>(*ranks.low) * scale);
    if (low >= 1.0) wide.low = std::min(size, static_cast<std::uint64_t>(low));
  }
  if (ranks.high) {
    const double high = std::ceil(static_cast<double>(*ranks.high) * scale);
    if (high <= static_cast<double>(size)) wide.high = static_cast<std::uint64_t>(high);
  }
  return wide;
}

QuantileRanks clustered_quantile_ranks(std::span<const ClusterSum> clusters, double p, double level) {
  const double n = std::floor(effective_trials(clusters, level));
  if (n < 1.0) return {};
  return stretched(quantile_ranks(static_cast<std::uint64_t>(n), p, level), n, sums_of(clusters).count);
}

QuantileRanks clustered_confidence_sequence_ranks(std::span<const ClusterSum> clusters, std::uint64_t largest, double p,
                                                  double level) {
  // At the quantile x, a cluster's values at or below x, less p of all its values, over the largest number a cluster
  // has, lie in [-p, 1 - p] and have mean 0: with p added they are shares of mean p. Their sum is accepted between the
  // whole numbers next to those that are.
  const Sums sums = sums_of(clusters);
  const std::uint64_t n = clusters.size();
  const QuantileRanks shares = confidence_sequence_ranks(n, p, level);
  const auto size = static_cast<double>(sums.count);
  const double most = static_cast<double>(largest) * static_cast<double>(n);
  const auto values_at = [&](double accepted) { return static_cast<double>(largest) * accepted + p * (size - most); };
  QuantileRanks ranks;
  if (shares.low) {
    const double low = std::floor(values_at(static_cast<double>(*shares.low) - 1.0)) + 1.0;
    if (low >= 1.0) ranks.low = static_cast<std::uint64_t>(low);
  }
  if (shares.high) {
    const double high = std::ceil(values_at(static_cast<double>(*shares.high)));
    if (high <= size) ranks.high = static_cast<std::uint64_t>(high);
  }
  return ranks;
}

}  // namespace steerstat
