#include "statistics/proportion.hpp"

#include <cmath>
#include <stdexcept>

#include "core/normal.hpp"

namespace steerstat {

ProportionInterval wilson_interval(std::uint64_t successes, std::uint64_t trials, double level) {
  if (trials == 0 || successes > trials) throw std::invalid_argument("wilson_interval: needs successes <= trials > 0");
  if (!(level > 0.0 && level < 1.0)) throw std::invalid_argument("wilson_interval: needs a level in (0, 1)");
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

}  // namespace steerstat
