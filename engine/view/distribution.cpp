#include "view/distribution.hpp"

#include <algorithm>

#include "statistics/distribution_band.hpp"
#include "statistics/sample.hpp"

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
  sort_ascending(values);
  const std::vector<std::size_t> ranks = shown_ranks(values.size());
  const auto n = static_cast<double>(values.size());
  for (std::size_t k = 0; k < ranks.size(); ++k) {
    const double x = values[ranks[k]];
    if (!result.x.empty() && result.x.back() == x) continue;
    // f is the share at or below: values that tie with this one count too.
    const auto here = values.begin() + static_cast<std::ptrdiff_t>(ranks[k]);
    result.x.push_back(x);
    result.f.push_back(static_cast<double>(std::upper_bound(here, values.end(), x) - values.begin()) / n);
  }
  result.band_note = values.empty() ? "there are no trials" : obstacle;
  if (result.band_note.empty()) result.band = {level, distribution_band(values.size(), level)};
  return result;
}

}  // namespace steerstat
