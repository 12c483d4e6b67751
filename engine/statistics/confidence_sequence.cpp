#include "statistics/confidence_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/elementary.hpp"

namespace steerstat {
namespace {

/// What Stirling's formula misses: log gamma(x) - ((x - 1/2) log x - x + log(2 pi) / 2). @param x  > 0
double stirling_remainder(double x) {
  // gamma(x + 1) = x gamma(x) carries x to where the asymptotic series [NIST 2010, 5.11.1] is right to 1e-14.
  double remainder = 0.0;
  while (x < 10.0) {
    remainder += (x + 0.5) * natural_log(1.0 + 1.0 / x) - 1.0;
    x += 1.0;
  }
  const double r = 1.0 / (x * x);
  return remainder + (1.0 / 12 - r * (1.0 / 360 - r * (1.0 / 1260 - r * (1.0 / 1680 - r / 1188)))) / x;
}

/// count log(observed / expected), 0 where there is none to count.
double surprise(double count, double observed, double expected) {
  if (count == 0.0) return 0.0;
  if (expected == 0.0) return std::numeric_limits<double>::infinity();
  return count * natural_log(observed / expected);
}

/// log(1 / alpha). @throws std::invalid_argument for a level outside (0, 1)
double log_threshold(double level) {
  if (!(level > 0.0 && level < 1.0)) {
    throw std::invalid_argument("a confidence sequence needs a level in (0, 1)");
  }
  return -natural_log(1.0 - level);
}

/// The end of the interval between a proportion inside it and one beyond it, by bisection down to neighbouring doubles.
/// @return the one outside, so that the interval is never too short
double bisect(std::uint64_t successes, std::uint64_t trials, double threshold, double inside, double outside) {
  for (;;) {
    const double middle = inside + (outside - inside) / 2.0;
    if (middle == inside || middle == outside) return outside;
    (log_mixture_ratio(successes, trials, middle) < threshold ? inside : outside) = middle;
  }
}

}  // namespace

double log_mixture_ratio(std::uint64_t successes, std::uint64_t trials, double p) {
  // B(S + 1/2, F + 1/2) / B(1/2, 1/2) by Stirling's formula: its leading terms, taken together with those of p, are
  // sums of logarithms of ratios near 1, so that large counts lose no digits.
  if (trials == 0) return 0.0;
  const auto s = static_cast<double>(successes);
  const auto f = static_cast<double>(trials - successes);
  const double n = s + f + 1.0;
  const double leading = surprise(s, (s + 0.5) / n, p) + surprise(f, (f + 0.5) / n, 1.0 - p);
  constexpr double half_log_two_over_pi = -0.22579135264472743236;  // log(2 pi) / 2 - log B(1/2, 1/2)
  return leading - 0.5 * natural_log(n) + half_log_two_over_pi + stirling_remainder(s + 0.5) +
         stirling_remainder(f + 0.5) - stirling_remainder(n);
}

ProportionInterval confidence_sequence(std::uint64_t successes, std::uint64_t trials, double level) {
  if (trials == 0 || successes > trials) {
    throw std::invalid_argument("confidence_sequence: needs successes <= trials > 0");
  }
  const double threshold = log_threshold(level);
  // The ratio is least at the estimate, and below 1 there: a mixture explains nothing better than the best in
  // hindsight.
  const double estimate = static_cast<double>(successes) / static_cast<double>(trials);
  const double low = successes == 0 ? 0.0 : bisect(successes, trials, threshold, estimate, 0.0);
  const double high = successes == trials ? 1.0 : bisect(successes, trials, threshold, estimate, 1.0);
  return {estimate, low, high, level};
}

QuantileRanks confidence_sequence_ranks(std::uint64_t n, double p, double level) {
  const double threshold = log_threshold(level);
  if (!(p > 0.0 && p < 1.0)) throw std::invalid_argument("confidence_sequence_ranks: needs p in (0, 1)");
  const auto accepted = [&](std::uint64_t count) { return log_mixture_ratio(count, n, p) < threshold; };
  // The ratio falls with the count k while k + 1/2 < n p and rises from there on. Its mean under p is 1, so that it is
  // below the threshold where it is least.
  const double least = std::ceil(static_cast<double>(n) * p - 0.5);
  const auto centre = std::min(n, static_cast<std::uint64_t>(std::max(0.0, least)));
  std::uint64_t fewest = centre;  // accepted
  for (std::uint64_t refused = 0; fewest > refused;) {
    const std::uint64_t middle = refused + (fewest - refused) / 2;
    if (accepted(middle)) {
      fewest = middle;
    } else {
      refused = middle + 1;
    }
  }
  std::uint64_t most = centre;  // accepted
  for (std::uint64_t refused = n; most < refused;) {
    const std::uint64_t middle = refused - (refused - most) / 2;
    if (accepted(middle)) {
      most = middle;
    } else {
      refused = middle - 1;
    }
  }
  QuantileRanks ranks;
  if (fewest > 0) ranks.low = fewest;
  if (most < n) ranks.high = most + 1;
  return ranks;
}

SampleInterval quantile_confidence_sequence(std::span<const double> sorted, double p, double level) {
  return between(sorted, confidence_sequence_ranks(sorted.size(), p, level));
}

}  // namespace steerstat
