#include "statistics/sensitivity_interval.hpp"

#include <algorithm>
#include <cmath>

#include "core/normal.hpp"

namespace steerstat {

std::optional<SensitivityIndex> bootstrap_interval(double estimate, std::span<const double> resampled, double level,
                                                   double degenerate_variance) {
  double sum = 0.0;
  double count = 0.0;
  for (const double x : resampled) {
    if (std::isnan(x)) continue;
    sum += x;
    count += 1.0;
  }
  if (!(std::isfinite(estimate) && count >= 2.0 && 2.0 * count >= static_cast<double>(resampled.size()))) {
    return std::nullopt;
  }
  double squares = 0.0;
  for (const double x : resampled) {
    if (!std::isnan(x)) squares += (x - sum / count) * (x - sum / count);
  }
  const double shown = squares / (count - 1.0);
  const double variance = std::max(shown - 2.0 * degenerate_variance, std::min(shown, degenerate_variance));
  const double reach = -normal_quantile((1.0 - level) / 2.0) * std::sqrt(variance);
  return SensitivityIndex{estimate, estimate - reach, estimate + reach};
}

}  // namespace steerstat
