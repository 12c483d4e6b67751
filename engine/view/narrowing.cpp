#include "view/narrowing.hpp"

#include <algorithm>
#include <cmath>

#include "report/independence.hpp"
#include "statistics/clustered.hpp"

namespace steerstat {
namespace {

// Numbers from 1 to `most`, rising, evenly spaced on a log axis as far as whole numbers can be.
std::vector<std::uint64_t> log_spaced(std::uint64_t most, std::size_t points) {
  std::vector<std::uint64_t> numbers;
  if (most == 0) return numbers;
  const double step = points > 1 ? std::log(static_cast<double>(most)) / static_cast<double>(points - 1) : 0.0;
  for (std::size_t k = 0; k < points; ++k) {
    const auto number = static_cast<std::uint64_t>(std::llround(std::exp(step * static_cast<double>(k))));
    if (numbers.empty() || number > numbers.back()) numbers.push_back(std::min(number, most));
  }
  if (numbers.back() != most) numbers.push_back(most);
  return numbers;
}

}  // namespace

Narrowing narrowing_of(const ViewedStudy& viewed, std::size_t points) {
  const Plan plan(viewed.study);
  const TrialTable& trials = viewed.result.trials;
  std::size_t prefix = 0;
  while (prefix < trials.index.size() && trials.index[prefix] == prefix) ++prefix;

  Narrowing narrowing;
  narrowing.intervals = viewed.study.intervals;
  for (std::size_t row = 0; row < prefix; ++row) narrowing.of += plan.is_independent(row) ? 1U : 0U;
  const bool by_draw = Independence(viewed.study, plan, viewed.result).unit(false) == IntervalUnit::draw;
  const std::vector<std::uint64_t> wanted = log_spaced(narrowing.of, points);
  auto next = wanted.begin();
  std::uint64_t counted = 0;
  std::uint64_t converged = 0;
  std::vector<ClusterSum> draws;
  for (std::size_t row = 0; row < prefix && next != wanted.end(); ++row) {
    if (!plan.is_independent(row)) continue;
    const std::uint64_t success = trials.outcomes[row].status == Status::converged ? 1U : 0U;
    ++counted;
    converged += success;
    if (row % plan.cells() == 0) draws.push_back({0, 0.0});
    ++draws.back().count;
    draws.back().total += static_cast<double>(success);
    const bool whole_draw = (row + 1) % plan.cells() == 0 || counted == narrowing.of;
    if (counted < *next || !whole_draw) continue;
    const auto& [method, level] = narrowing.intervals;
    const ProportionInterval interval =
        by_draw ? clustered_proportion(method, draws, level) : proportion_interval(method, converged, counted, level);
    narrowing.trials.push_back(counted);
    narrowing.estimate.push_back(interval.estimate);
    narrowing.low.push_back(interval.low);
    narrowing.high.push_back(interval.high);
    while (next != wanted.end() && *next <= counted) ++next;
  }
  return narrowing;
}

}  // namespace steerstat
