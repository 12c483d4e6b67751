#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace steerstat {

/// Coefficients of (11) in powers of lambda = t/T, from lambda^1 to lambda^5; there is no constant term.
inline constexpr std::array<double, 5> cycle_coefficients{3.0, -30.0, 90.0, -105.0, 42.0};

/// beta of (12)-(13): half the integral over [0, 1] of the square of (11)'s first integral (A = T = 1), §4.1.
inline constexpr double beta = 3.0 / 80080.0;

/// The largest |value| of (11)'s polynomial on [0, 1] (at 0.33 and 0.67), rounded up; A / T^2 times it bounds the
/// cycle's |a|.
inline constexpr double cycle_peak = 0.12352;

/// The largest |value| on [0, 1] of (11)'s second integral, l^3 (1 - l)^3 (1 - 2 l) / 2 (at 0.311 and 0.689),
/// rounded up; A times it bounds how far a cycle that starts at rest takes the first joint.
inline constexpr double cycle_excursion = 0.0018595191;

/// a(t) of (11) [m/s^2].
///
/// @param amplitude A [m], @param period T [s] > 0, @param t [s] since the cycle's start, 0 <= t <= T
template <class Real>
Real cycle_acceleration(const Real& amplitude, const Real& period, const Real& t) {
  const Real lambda = t / period;
  Real sum(cycle_coefficients[4]);
  for (int i = 3; i >= 0; --i) sum = sum * lambda + Real(cycle_coefficients[static_cast<std::size_t>(i)]);
  return amplitude / (period * period) * (sum * lambda);
}

/// Where (11)'s polynomial is level in the first half of [0, 1]; in the second it repeats itself with the other sign.
inline constexpr std::array<double, 2> cycle_summits{0.06943184420297371239, 0.33000947820757186760};

/// The largest |a| of (11) from a cycle's start to t [m/s^2].
inline double cycle_peak_acceleration(double amplitude, double period, double t) {
  double peak = std::abs(cycle_acceleration(amplitude, period, t));
  for (const double summit : cycle_summits) {
    if (summit * period < t) peak = std::max(peak, std::abs(cycle_acceleration(amplitude, period, summit * period)));
  }
  return peak;
}

}  // namespace steerstat
