#include "statistics/weighted_failures.hpp"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <stdexcept>

#include "statistics/exact_sum.hpp"

namespace steerstat {
namespace {

/// Sums of weights, exact, so that the order of the draws decides no bit.
struct WeightSums {
  ExactSum weights;
  ExactSum squares;
  double largest{0.0};

  void add(double weight) {
    weights.add(weight);
    squares.add(weight * weight);
    largest = std::max(largest, weight);
  }
  [[nodiscard]] double effective() const {
    const double sum = weights.value();
    return sum > 0.0 ? sum * sum / squares.value() : 0.0;
  }
};

std::string distrust(const WeightedFailures& found, double mean_weight_error) {
  if (std::abs(found.mean_weight - 1.0) > 4.0 * mean_weight_error) {
    return "the weights do not average to 1: the proposal leaves out regions that matter; give the nominal draws a "
           "larger share";
  }
  if (found.failures == 0) return "no draw failed; the interval is that of the nominal draws";
  if (found.effective_failures < WeightedFailures::least_effective_failures) {
    return "too few failures count; run more trials, or move the proposal to where they are";
  }
  if (found.largest_share > WeightedFailures::largest_trusted_share) {
    return "one failure weighs too much: the proposal misses where it lies; add a component there";
  }
  return "";
}

}  // namespace

WeightedSumInterval weighted_sum_interval(double sum, double squares, double largest, double level) {
  if (!(sum > 0.0 && squares > 0.0 && largest > 0.0 && level > 0.0 && level < 1.0)) {
    throw std::invalid_argument("weighted_sum_interval: needs weights above 0 and a level in (0, 1)");
  }
  const double tail = (1.0 - level) / 2.0;
  // Quantiles of a gamma variable that has the sum's mean and variance.
  const double low = squares / sum * boost::math::gamma_p_inv(sum * sum / squares, tail);
  const double more = sum + largest;
  const double more_squares = squares + largest * largest;
  return {low, more_squares / more * boost::math::gamma_q_inv(more * more / more_squares, tail)};
}

WeightedFailures weighted_failures(std::span<const WeightedDraw> draws, double level) {
  if (draws.empty()) throw std::invalid_argument("weighted_failures: needs draws");
  WeightSums all;
  WeightSums failed;
  WeightedFailures found;
  found.draws = draws.size();
  for (const WeightedDraw& draw : draws) {
    all.add(draw.weight);
    found.nominal.trials += draw.nominal ? 1U : 0U;
    if (!draw.failed) continue;
    failed.add(draw.weight);
    ++found.failures;
    found.nominal.successes += draw.nominal ? 1U : 0U;
  }
  const auto n = static_cast<double>(draws.size());
  const double sum = failed.weights.value();
  found.estimate = sum / n;
  found.standard_error = std::sqrt(std::max(failed.squares.value() / n - found.estimate * found.estimate, 0.0) / n);
  found.effective_draws = all.effective();
  found.effective_failures = failed.effective();
  found.largest_share = sum > 0.0 ? failed.largest / sum : 0.0;
  found.mean_weight = all.weights.value() / n;
  const double spread = all.squares.value() / n - found.mean_weight * found.mean_weight;
  found.reason = distrust(found, std::sqrt(std::max(spread, 0.0) / n));
  found.trusted = found.reason.empty();
  if (found.nominal.trials > 0) {
    found.nominal_interval = clopper_pearson_interval(found.nominal.successes, found.nominal.trials, level);
  }
  if (found.trusted) {
    const auto [low, high] = weighted_sum_interval(sum, failed.squares.value(), failed.largest, level);
    found.low = low / n;
    found.high = std::min(high / n, 1.0);
  } else if (found.nominal_interval) {
    found.low = found.nominal_interval->low;
    found.high = found.nominal_interval->high;
  }
  return found;
}

}  // namespace steerstat
