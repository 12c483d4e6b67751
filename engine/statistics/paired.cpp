#include "statistics/paired.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/normal.hpp"

namespace steerstat {
namespace {

/// The score statistic of a difference, falling from +infinity to -infinity over (-1, 1) [Tango 1998].
class ScoreStatistic {
 public:
  explicit ScoreStatistic(const PairedCounts& counts)
      : n_(static_cast<double>(counts.pairs())),
        b_only_(static_cast<double>(counts.b_only)),
        a_only_(static_cast<double>(counts.a_only)) {}

  /// @param difference  in (-1, 1)
  [[nodiscard]] double at(double difference) const {
    const double variance = n_ * (2.0 * a_only_probability(difference) + difference * (1.0 - difference));
    return (b_only_ - a_only_ - n_ * difference) / std::sqrt(variance);
  }

 private:
  /// The most likely probability of "A alone" where that of "B alone" exceeds it by `difference`: the larger root of
  /// 2 n q^2 + linear q - constant = 0.
  [[nodiscard]] double a_only_probability(double difference) const {
    const double linear = (2.0 * n_ - b_only_ + a_only_) * difference - (b_only_ + a_only_);
    const double constant = a_only_ * difference * (1.0 - difference);
    const double root = std::sqrt(std::max(0.0, linear * linear + 8.0 * n_ * constant));
    // Of the root's two forms the one that subtracts nothing.
    return linear > 0.0 ? 2.0 * constant / (root + linear) : (root - linear) / (4.0 * n_);
  }

  double n_, b_only_, a_only_;
};

/// The largest difference that the score test does not reject; halves its bracket until doubles end.
double upper_limit(const PairedCounts& counts, double z) {
  if (counts.b_only == counts.pairs()) return 1.0;
  const ScoreStatistic score(counts);
  double low = difference_of(counts);
  double high = 1.0;
  for (;;) {
    const double middle = std::midpoint(low, high);
    if (!(low < middle && middle < high)) return middle;
    (score.at(middle) > -z ? low : high) = middle;
  }
}

}  // namespace

double difference_of(const PairedCounts& counts) {
  return (static_cast<double>(counts.b_only) - static_cast<double>(counts.a_only)) /
         static_cast<double>(counts.pairs());
}

McNemarTest mcnemar_test(const PairedCounts& counts) {
  if (counts.a_only == counts.b_only) return {1.0, 1.0};
  const boost::math::binomial_distribution<double> chance(static_cast<double>(counts.a_only + counts.b_only), 0.5);
  const auto fewer = static_cast<double>(std::min(counts.a_only, counts.b_only));
  const double tail = 2.0 * cdf(chance, fewer);
  return {std::min(tail, 1.0), std::min(tail - pdf(chance, fewer), 1.0)};
}

DifferenceInterval tango_interval(const PairedCounts& counts, double level) {
  if (counts.pairs() == 0) throw std::invalid_argument("tango_interval: needs a pair");
  if (!(level > 0.0 && level < 1.0)) throw std::invalid_argument("tango_interval: needs a level in (0, 1)");
  const double z = -normal_quantile((1.0 - level) / 2.0);
  PairedCounts swapped = counts;
  std::swap(swapped.a_only, swapped.b_only);
  return {difference_of(counts), -upper_limit(swapped, z), upper_limit(counts, z), level};
}

std::vector<double> holm_adjusted(std::span<const double> p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return p_values[i] < p_values[j]; });
  std::vector<double> adjusted(p_values.size());
  double largest = 0.0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const auto hypotheses = static_cast<double>(order.size() - rank);
    largest = std::max(largest, std::min(1.0, hypotheses * p_values[order[rank]]));
    adjusted[order[rank]] = largest;
  }
  return adjusted;
}

}  // namespace steerstat
