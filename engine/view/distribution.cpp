#include "view/distribution.hpp"

#include <algorithm>

#include "statistics/distribution_band.hpp"

namespace steerstat {
namespace {

// Ranks from 0, rising: all, or as many as may be shown, evenly spaced, the first and the last among them.
std::vector<std::size_t> shown_ranks(std::size_t n) {
  const std::size_t shown = std::min(n, most_distribution_points);
  std::vector<std::size_t> ranks;
  ranks.reserve(shown);
  for (std::size_t k = 0; k < shown; ++k) ranks.push_back(shown == n ? k : k * (n - 1) / (shown - 1));
  return ranks;
}

// Puts the order statistics at ranks[first, last) in their places, among values[from, to): sorting all of a million
// takes twice as long.
void select(std::vector<double>& values, const std::vector<std::size_t>& ranks, std::size_t first, std::size_t last,
            std::size_t from, std::size_t to) {
  if (first >= last) return;
  const std::size_t middle = first + (last - first) / 2;
  const std::size_t rank = ranks[middle];
  const auto at = [&](std::size_t i) { return values.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(from), at(rank), at(to));
  select(values, ranks, first, middle, from, rank);
  select(values, ranks, middle + 1, last, rank + 1, to);
}

}  // namespace

std::string obstacle_to_band(const Study& study, std::uint64_t cells) {
  if (!draws(study.sampling.method)) return "the trials are not drawn";
  const SamplingMethod method = study.sampling.method;
  const bool sequence = method == SamplingMethod::sobol ||
                        (method == SamplingMethod::sobol_indices && study.sampling.base == SobolIndicesBase::sobol);
  if (sequence || method == SamplingMethod::latin_hypercube) return "the points of the design are not independent";
  if (cells > 1) return "trials of different cells share their draws";
  if (study.stop) return "the trials themselves decided how many they are";
  return "";
}

EmpiricalDistribution empirical_distribution(std::string metric, std::string unit, std::vector<double> values,
                                             const std::string& obstacle, double level) {
  EmpiricalDistribution result;
  result.metric = std::move(metric);
  result.unit = std::move(unit);
  result.trials = values.size();
  const std::vector<std::size_t> ranks = shown_ranks(values.size());
  select(values, ranks, 0, ranks.size(), 0, values.size());
  const auto n = static_cast<double>(values.size());
  for (std::size_t k = 0; k < ranks.size(); ++k) {
    const double x = values[ranks[k]];
    // f is the share at or below: values that tie with this one may stand between it and the next.
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(ranks[k]) + 1;
    const auto end = k + 1 < ranks.size() ? values.begin() + static_cast<std::ptrdiff_t>(ranks[k + 1]) : values.end();
    const auto at_or_below = static_cast<double>(ranks[k] + 1) + static_cast<double>(std::count(begin, end, x));
    if (!result.x.empty() && result.x.back() == x) {
      result.f.back() = at_or_below / n;
      continue;
    }
    result.x.push_back(x);
    result.f.push_back(at_or_below / n);
  }
  result.band_note = values.empty() ? "there are no trials" : obstacle;
  if (result.band_note.empty()) result.band = {level, distribution_band(values.size(), level)};
  return result;
}

}  // namespace steerstat
