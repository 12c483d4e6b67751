#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace steerstat {

/// The highest degree that first_descent() takes: the square of a dense output of order 12.
inline constexpr std::size_t highest_degree = 24;

/// Where a polynomial on [0, 1] first goes from positive to non-positive, however short the dip.
///
/// Works on Bernstein coefficients, whose signs bound the number of roots from above (variation diminishing,
/// [Farouki 2012]), so that a dip between any two samples cannot be missed. A touch that is within rounding of a
/// crossing is taken for one. Does not allocate.
///
/// @param coefficients  (degree + 1) of the powers of x, lowest first; degree from 0 to highest_degree
/// @param armed  whether the function has been positive before 0; set where it is positive somewhere up to the crossing
/// @return where it crosses, to the last bits and on the non-positive side; 0 where it is armed and non-positive from
///         the start; nothing where it does not cross
std::optional<double> first_descent(std::span<const double> coefficients, bool& armed);

}  // namespace steerstat
