#include "statistics/sample.hpp"

#include <algorithm>
#include <boost/sort/spreadsort/float_sort.hpp>
#include <cmath>
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

}  // namespace

void sort_ascending(std::span<double> sample) {
  boost::sort::spreadsort::float_sort(sample.begin(), sample.end());
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
