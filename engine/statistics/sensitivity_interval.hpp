#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace steerstat {

/// An estimated share of an output's variance, in [0, 1] but for its error, with its interval. A share that is known
/// without error has both limits at the estimate.
struct SensitivityIndex {
  double estimate;
  double low;
  double high;

  friend bool operator==(const SensitivityIndex&, const SensitivityIndex&) = default;
};

/// Fewer independent rows, or trials, than this say too little of an index.
inline constexpr std::size_t least_sensitivity_sample = 64;

/// The estimate with the normal interval of its bootstrap standard error [Efron and Tibshirani 1993, ch. 13], which
/// needs far fewer resamples than percentiles.
///
/// @param resampled  (resamples) estimates from the resamples; NaN where a resample gives none
/// @param degenerate_variance  that part of the estimate's variance which resamples show three times (given_data.hpp)
/// @return nothing where fewer than half of the resamples give an estimate
std::optional<SensitivityIndex> bootstrap_interval(double estimate, std::span<const double> resampled, double level,
                                                   double degenerate_variance = 0.0);

}  // namespace steerstat
