#include "statistics/proportion.hpp"

#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/normal.hpp"
#include "statistics/confidence_sequence.hpp"

namespace steerstat {
namespace {

void require_proportion(const char* function, std::uint64_t successes, std::uint64_t trials, double level) {
  if (trials == 0 || successes > trials) {
    throw std::invalid_argument(std::string(function) + ": needs successes <= trials > 0");
  }
  if (!(level > 0.0 && level < 1.0)) {
    throw std::invalid_argument(std::string(function) + ": needs a level in (0, 1)");
  }
}

}  // namespace

ProportionInterval wilson_interval(std::uint64_t successes, std::uint64_t trials, double level) {
  require_proportion("wilson_interval", successes, trials, level);
  const auto x = static_cast<double>(successes);
  const auto n = static_cast<double>(trials);
  const auto failures = static_cast<double>(trials - successes);
  const double z = -normal_quantile((1.0 - level) / 2.0);
  // The limits are the roots P of (n + z^2) P^2 - (2 x + z^2) P + x^2 / n = 0. The lower one is taken from their
  // product, x^2 / (n (n + z^2)), which loses no digits to cancellation and is exactly 0 without successes.
  const double upper_sum = x + z * z / 2.0 + z * std::sqrt(x * (failures / n) + z * z / 4.0);
  const double high = successes == trials ? 1.0 : std::fmin(upper_sum / (n + z * z), 1.0);
  return {x / n, x * (x / n) / upper_sum, high, level};
}

ProportionInterval clopper_pearson_interval(std::uint64_t successes, std::uint64_t trials, double level) {
  require_proportion("clopper_pearson_interval", successes, trials, level);
  const auto x = static_cast<double>(successes);
  const auto n = static_cast<double>(trials);
  const auto failures = static_cast<double>(trials - successes);
  const double tail = (1.0 - level) / 2.0;
  // P(at least x successes) at P is the regularised incomplete beta function I_P(x, n - x + 1).
  const double low = successes == 0 ? 0.0 : boost::math::ibeta_inv(x, failures + 1.0, tail);
  const double high = successes == trials ? 1.0 : boost::math::ibetac_inv(x + 1.0, failures, tail);
  return {x / n, low, high, level};
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
