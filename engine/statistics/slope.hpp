#pragma once

#include <span>

namespace steerstat {

/// The slope of the line through (x, y) by least squares. In logarithms it is the exponent of a power law.
///
/// @param x  (n) finite, at least two of them different
/// @param y  (n) finite
/// @throws std::invalid_argument otherwise
double least_squares_slope(std::span<const double> x, std::span<const double> y);

}  // namespace steerstat
