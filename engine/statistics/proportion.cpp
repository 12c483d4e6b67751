#include "statistics/proportion.hpp"

#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/normal.hpp"
#include "statistics/confidence_sequence.hpp"

namespace steerstat {
namespace {

void require_level(const char* function, double level) {
  if (!(level > 0.0 && level < 1.0)) {
    throw std::invalid_argument(std::string(function) + ": needs a level in (0, 1)");
  }
}

void require_proportion(const char* function, std::uint64_t successes, std::uint64_t trials, double level) {
  if (trials == 0 || successes > trials) {
    throw std::invalid_argument(std::string(function) + ": needs successes <= trials > 0");
  }
  require_level(function, level);
}

/// @param x, failures  >= 0 @param n  their sum
ProportionInterval wilson(double x, double failures, double n, double level) {
  const double z = -normal_quantile((1.0 - level) / 2.0);
  // The limits are the roots P of (n + z^2) P^2 - (2 x + z^2) P + x^2 / n = 0. The lower one is taken from their
  // product, x^2 / (n (n + z^2)), which loses no digits to cancellation and is exactly 0 without successes.
  const double upper_sum = x + z * z / 2.0 + z * std::sqrt(x * (failures / n) + z * z / 4.0);
  const double high = failures == 0.0 ? 1.0 : std::fmin(upper_sum / (n + z * z), 1.0);
  return {x / n, x * (x / n) / upper_sum, high, level};
}

/// @param x, failures  >= 0 @param n  their sum
ProportionInterval clopper_pearson(double x, double failures, double n, double level) {
  const double tail = (1.0 - level) / 2.0;
  // P(at least x successes) at P is the regularised incomplete beta function I_P(x, n - x + 1).
  const double low = x == 0.0 ? 0.0 : boost::math::ibeta_inv(x, failures + 1.0, tail);
  const double high = failures == 0.0 ? 1.0 : boost::math::ibetac_inv(x + 1.0, failures, tail);
  return {x / n, low, high, level};
}

}  // namespace

ProportionInterval wilson_interval(std::uint64_t successes, std::uint64_t trials, double level) {
  require_proportion("wilson_interval", successes, trials, level);
  return wilson(static_cast<double>(successes), static_cast<double>(trials - successes), static_cast<double>(trials),
                level);
}

ProportionInterval clopper_pearson_interval(std::uint64_t successes, std::uint64_t trials, double level) {
  require_proportion("clopper_pearson_interval", successes, trials, level);
  return clopper_pearson(static_cast<double>(successes), static_cast<double>(trials - successes),
                         static_cast<double>(trials), level);
}

ProportionInterval proportion_interval_of_share(ProportionMethod method, double share, double trials, double level) {
  require_level("proportion_interval_of_share", level);
  if (!(trials > 0.0 && share >= 0.0 && share <= 1.0) || method == ProportionMethod::confidence_sequence) {
    throw std::invalid_argument("proportion_interval_of_share: needs a share of trials, and no confidence sequence");
  }
  const auto interval_of = method == ProportionMethod::wilson ? wilson : clopper_pearson;
  ProportionInterval interval = interval_of(share * trials, (1.0 - share) * trials, trials, level);
  interval.estimate = share;
  return interval;
}

ProportionInterval proportion_interval(ProportionMethod method, std::uint64_t successes, std::uint64_t trials,
                                       double level) {
  switch (method) {
    case ProportionMethod::wilson:
      return wilson_interval(successes, trials, level);
    case ProportionMethod::clopper_pearson:
      return clopper_pearson_interval(successes, trials, level);
    case ProportionMethod::confidence_sequence:
      return confidence_sequence(successes, trials, level);
  }
  throw std::invalid_argument("proportion_interval: no such method");
}

}  // namespace steerstat
