#include "statistics/sample_interval.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <stdexcept>

namespace steerstat {
namespace {

void check_level(const char* message, double level) {
  if (!(level > 0.0 && level < 1.0)) throw std::invalid_argument(message);
}

/// The least k in [0, n] for which `holds`, which stays true once it is; n + 1 where it never is.
template <class Predicate>
std::uint64_t first_that(std::uint64_t n, const Predicate& holds) {
  std::uint64_t begin = 0;
  std::uint64_t end = n + 1;
  while (begin < end) {
    const std::uint64_t middle = begin + (end - begin) / 2;
    if (holds(middle)) {
      end = middle;
    } else {
      begin = middle + 1;
    }
  }
  return begin;
}

}  // namespace

QuantileRanks quantile_ranks(std::uint64_t n, double p, double level) {
  check_level("quantile_ranks: needs a level in (0, 1)", level);
  if (!(p > 0.0 && p < 1.0)) throw std::invalid_argument("quantile_ranks: needs p in (0, 1)");
  const boost::math::binomial_distribution<double> binomial(static_cast<double>(n), p);
  const double tail = (1.0 - level) / 2.0;
  // The value at rank r is above the quantile only if fewer than r of the values are at or below it, and below the
  // quantile only if at least r of them are.
  const std::uint64_t low =
      first_that(n, [&](std::uint64_t k) { return boost::math::cdf(binomial, static_cast<double>(k)) > tail; });
  const std::uint64_t beyond = first_that(n, [&](std::uint64_t k) {
    return boost::math::cdf(boost::math::complement(binomial, static_cast<double>(k))) <= tail;
  });
  QuantileRanks ranks;
  if (low > 0) ranks.low = low;
  if (beyond < n) ranks.high = beyond + 1;
  return ranks;
}

SampleInterval between(std::span<const double> sorted, const QuantileRanks& ranks) {
  SampleInterval interval;
  if (ranks.low) interval.low = sorted[*ranks.low - 1];
  if (ranks.high) interval.high = sorted[*ranks.high - 1];
  return interval;
}

SampleInterval quantile_interval(std::span<const double> sorted, double p, double level) {
  return between(sorted, quantile_ranks(sorted.size(), p, level));
}

SampleInterval mean_interval(double mean, std::optional<double> std, std::uint64_t n, double level) {
  check_level("mean_interval: needs a level in (0, 1)", level);
  if (n < 2 || !std) return {};
  const boost::math::students_t_distribution<double> student(static_cast<double>(n - 1));
  const double t = boost::math::quantile(boost::math::complement(student, (1.0 - level) / 2.0));
  const double reach = t * *std / std::sqrt(static_cast<double>(n));
  return {mean - reach, mean + reach};
}

}  // namespace steerstat
