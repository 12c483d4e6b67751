#include "statistics/sample.hpp"

#include <algorithm>
#include <bit>
#include <boost/sort/spreadsort/integer_sort.hpp>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "statistics/exact_sum.hpp"

namespace steerstat {
namespace {

double mean_of(std::span<const double> sample) {
  ExactSum sum;
  for (const double x : sample) sum.add(x);
  return sum.value() / static_cast<double>(sample.size());
}

std::optional<double> standard_deviation(std::span<const double> sample, double mean) {
  if (sample.size() < 2) return std::nullopt;
  ExactSum squares;
  for (const double x : sample) squares.add((x - mean) * (x - mean));
  return std::sqrt(squares.value() / static_cast<double>(sample.size() - 1));
}

constexpr std::uint64_t sign_bit = std::uint64_t{1} << 63;

/// A whole number in whose order numbers are.
std::uint64_t key_of(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  return (bits & sign_bit) != 0 ? ~bits : bits | sign_bit;
}

double number_of(std::uint64_t key) {
  return std::bit_cast<double>((key & sign_bit) != 0 ? key & ~sign_bit : ~key);
}

}  // namespace

void sort_ascending(std::span<double> sample) {
  // Boost's float_sort takes differences of signed bit patterns, which overflow where signs are mixed.
  std::vector<std::uint64_t> keys(sample.size());
  std::ranges::transform(sample, keys.begin(), key_of);
  boost::sort::spreadsort::integer_sort(keys.begin(), keys.end());
  std::ranges::transform(keys, sample.begin(), number_of);
}

double quantile(std::span<const double> sorted, double p) {
  if (sorted.empty()) throw std::invalid_argument("quantile: needs a sample that is not empty");
  if (!(p >= 0.0 && p <= 1.0)) throw std::invalid_argument("quantile: needs p in [0, 1]");
  const double h = static_cast<double>(sorted.size() - 1) * p;
  const auto below = static_cast<std::size_t>(h);
  if (below + 1 >= sorted.size()) return sorted.back();
  return std::lerp(sorted[below], sorted[below + 1], h - static_cast<double>(below));
}

std::optional<SampleStatistics> describe(std::span<const double> sample) {
  if (sample.empty()) return std::nullopt;
  std::vector<double> sorted(sample.begin(), sample.end());
  sort_ascending(sorted);
  // Dividing the rounded sum can leave the sample's range by an ulp, most visibly for a constant sample.
  const double mean = std::clamp(mean_of(sample), sorted.front(), sorted.back());
  return SampleStatistics{mean,
                          standard_deviation(sample, mean),
                          sorted.front(),
                          quantile(sorted, 0.05),
                          quantile(sorted, 0.50),
                          quantile(sorted, 0.95),
                          quantile(sorted, 0.99),
                          sorted.back(),
                          sorted.size()};
}

}  // namespace steerstat
