#pragma once

#include <cmath>
#include <limits>

#include "core/elementary.hpp"

namespace steerstat {

namespace normal {
// Coefficients of PPND16 [Wichura 1988], highest order first.
inline constexpr double central_numerator[] = {
    2.5090809287301226727e+3, 3.3430575583588128105e+4, 6.7265770927008700853e+4, 4.5921953931549871457e+4,
    1.3731693765509461125e+4, 1.9715909503065514427e+3, 1.3314166789178437745e+2, 3.3871328727963666080e+0};
inline constexpr double central_denominator[] = {
    5.2264952788528545610e+3, 2.8729085735721942674e+4, 3.9307895800092710610e+4, 2.1213794301586595867e+4,
    5.3941960214247511077e+3, 6.8718700749205790830e+2, 4.2313330701600911252e+1, 1.0};
inline constexpr double middle_numerator[] = {
    7.74545014278341407640e-4, 2.27238449892691845833e-2, 2.41780725177450611770e-1, 1.27045825245236838258e+0,
    3.64784832476320460504e+0, 5.76949722146069140550e+0, 4.63033784615654529590e+0, 1.42343711074968357734e+0};
inline constexpr double middle_denominator[] = {
    1.05075007164441684324e-9, 5.47593808499534494600e-4, 1.51986665636164571966e-2, 1.48103976427480074590e-1,
    6.89767334985100004550e-1, 1.67638483018380384940e+0, 2.05319162663775882187e+0, 1.0};
inline constexpr double tail_numerator[] = {
    2.01033439929228813265e-7, 2.71155556874348757815e-5, 1.24266094738807843860e-3, 2.65321895265761230930e-2,
    2.96560571828504891230e-1, 1.78482653991729133580e+0, 5.46378491116411436990e+0, 6.65790464350110377720e+0};
inline constexpr double tail_denominator[] = {
    2.04426310338993978564e-15, 1.42151175831644588870e-7, 1.84631831751005468180e-5, 7.86869131145613259100e-4,
    1.48753612908506148525e-2,  1.36929880922735805310e-1, 5.99832206555887937690e-1, 1.0};

inline double ratio(const double (&numerator)[8], const double (&denominator)[8], double r) {
  double p = numerator[0];
  double q = denominator[0];
  for (int i = 1; i < 8; ++i) {
    p = std::fma(p, r, numerator[i]);
    q = std::fma(q, r, denominator[i]);
  }
  return p / q;
}
}  // namespace normal

/// Quantile of the standard normal distribution, PPND16 of algorithm AS 241 [Wichura 1988].
///
/// The same bits on every machine. Relative error below 1e-15, but for that of 1 - p where p is near 1: use
/// -normal_quantile(1 - p) when the upper tail's probability is what is known.
///
/// @param p  in [0, 1]; -infinity at 0, +infinity at 1, NaN outside
inline double normal_quantile(double p) {
  if (!(p >= 0.0 && p <= 1.0)) return std::numeric_limits<double>::quiet_NaN();
  const double q = p - 0.5;
  if (std::abs(q) <= 0.425) {
    return q * normal::ratio(normal::central_numerator, normal::central_denominator, std::fma(-q, q, 0.180625));
  }
  const double tail = q < 0.0 ? p : 1.0 - p;
  if (tail == 0.0) return std::copysign(std::numeric_limits<double>::infinity(), q);
  const double r = std::sqrt(-natural_log(tail));
  const double z = r <= 5.0 ? normal::ratio(normal::middle_numerator, normal::middle_denominator, r - 1.6)
                            : normal::ratio(normal::tail_numerator, normal::tail_denominator, r - 5.0);
  return q < 0.0 ? -z : z;
}

}  // namespace steerstat
