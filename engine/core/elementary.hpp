#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

/// Elementary functions whose bits do not depend on the machine, the instruction set or the C library: only
/// + - * / fma, rounding and bit operations. Whatever decides a trial's draws or its outcome uses these, never
/// <cmath>'s own. All are pure and thread-safe.
namespace steerstat {

/// Sine and cosine of one angle.
template <class Real>
struct SinCos {
  Real sin;
  Real cos;
};

/// Constants of the polynomials and reductions below, shared with the vectorised forms.
namespace elementary {
inline constexpr double two_over_pi = 0x1.45f306dc9c883p-1;
// pi/2 as a sum of two doubles: subtracting n times the first by fma is exact while n fits in 52 bits.
inline constexpr double half_pi_high = 0x1.921fb54442d18p+0;
inline constexpr double half_pi_low = 0x1.1a62633145c07p-54;
// Taylor coefficients, highest order first. On |r| <= pi/4 the first term left out is below 2^-58 of the result.
inline constexpr double sine[] = {
    1.0 / 355687428096000.0, -1.0 / 1307674368000.0, 1.0 / 6227020800.0, -1.0 / 39916800.0,
    1.0 / 362880.0,          -1.0 / 5040.0,          1.0 / 120.0,        -1.0 / 6.0};
inline constexpr double cosine[] = {1.0 / 20922789888000.0, -1.0 / 87178291200.0, 1.0 / 479001600.0, -1.0 / 3628800.0,
                                    1.0 / 40320.0,          -1.0 / 720.0,         1.0 / 24.0,        -1.0 / 2.0};
inline constexpr double log2_e = 0x1.71547652b82fep+0;
inline constexpr double ln2_high = 0x1.62e42fefa39efp-1;
inline constexpr double ln2_low = 0x1.abc9e3b39803fp-56;
}  // namespace elementary

/// sin x and cos x, x in radians.
///
/// Absolute error below 1.5 * 2^-53 for |x| <= 2^22; beyond that the reduction loses accuracy but not its
/// determinism. NaN for a non-finite x.
inline SinCos<double> sincos(double x) {
  namespace k = elementary;
  const double n = std::nearbyint(x * k::two_over_pi);
  const double r = std::fma(-n, k::half_pi_low, std::fma(-n, k::half_pi_high, x));
  const double r2 = r * r;
  double p = k::sine[0];
#pragma GCC unroll 8
  for (int i = 1; i < 8; ++i) p = std::fma(p, r2, k::sine[i]);
  const double s = std::fma(p * r2, r, r);
  double q = k::cosine[0];
#pragma GCC unroll 8
  for (int i = 1; i < 8; ++i) q = std::fma(q, r2, k::cosine[i]);
  const double c = std::fma(q, r2, 1.0);
  // The quadrant n mod 4, without an integer conversion that a huge or non-finite n would make undefined.
  const double quadrant = n - 4.0 * std::floor(n * 0.25);
  const bool odd = quadrant == 1.0 || quadrant == 3.0;
  const double sine = odd ? c : s;
  const double cosine = odd ? s : c;
  return {quadrant >= 2.0 ? -sine : sine, (quadrant == 1.0 || quadrant == 2.0) ? -cosine : cosine};
}

/// Natural logarithm of a finite x > 0; relative error below 4 * 2^-53 (absolute near x = 1). -infinity at 0, NaN
/// below.
inline double natural_log(double x) {
  if (!(x > 0.0)) return x == 0.0 ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
  if (x == std::numeric_limits<double>::infinity()) return x;
  double exponent = 0.0;
  if (x < std::numeric_limits<double>::min()) {  // subnormal: make it normal first
    x *= 0x1p54;
    exponent = -54.0;
  }
  const auto bits = std::bit_cast<std::uint64_t>(x);
  double mantissa = std::bit_cast<double>((bits & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL);  // [1, 2)
  exponent += static_cast<double>(static_cast<std::int64_t>(bits >> 52) - 1023);
  if (mantissa > 0x1.6a09e667f3bcdp+0) {  // above sqrt 2: centre on 1
    mantissa *= 0.5;
    exponent += 1.0;
  }
  const double f = (mantissa - 1.0) / (mantissa + 1.0);  // log m = 2 atanh f, |f| < 0.172
  const double f2 = f * f;
  double p = 1.0 / 23.0;
  for (double odd = 21.0; odd >= 3.0; odd -= 2.0) p = std::fma(p, f2, 1.0 / odd);
  const double log_mantissa = std::fma(2.0 * f * f2, p, 2.0 * f);
  return std::fma(exponent, elementary::ln2_high, std::fma(exponent, elementary::ln2_low, log_mantissa));
}

/// e^x; relative error below 4 * 2^-53. 0 below -745.2, +infinity above 709.8.
inline double exponential(double x) {
  if (!(x < 709.79)) return x != x ? x : std::numeric_limits<double>::infinity();
  if (x < -745.2) return 0.0;
  const double n = std::nearbyint(x * elementary::log2_e);
  const double r = std::fma(-n, elementary::ln2_low, std::fma(-n, elementary::ln2_high, x));  // |r| < 0.35
  double p = 1.0 / 87178291200.0;                                                             // 1/14!
  double factorial = 87178291200.0;
  for (double k = 14.0; k >= 1.0; k -= 1.0) {
    factorial /= k;  // exact: every factorial up to 14! is a double
    p = std::fma(p, r, 1.0 / factorial);
  }
  // Two factors, so that neither leaves the normal range.
  const auto power = static_cast<std::int64_t>(n);
  const std::int64_t half = power / 2;
  const auto two_to = [](std::int64_t e) { return std::bit_cast<double>(static_cast<std::uint64_t>(e + 1023) << 52); };
  return p * two_to(half) * two_to(power - half);
}

/// arcsin x for x in [0, 1]; relative error below 8 * 2^-53. NaN above 1.
inline double arc_sine(double x) {
  // asin x = 8 atan z after three half-angle steps, z <= tan(pi/16).
  double z = x / (1.0 + std::sqrt((1.0 - x) * (1.0 + x)));
  z = z / (1.0 + std::sqrt(1.0 + z * z));
  z = z / (1.0 + std::sqrt(1.0 + z * z));
  const double z2 = z * z;
  double p = 0.0;
#pragma GCC unroll 12
  for (int odd = 23; odd >= 3; odd -= 2) p = 1.0 / odd - z2 * p;  // unrolled, it divides at compile time
  return 8.0 * (z - z * z2 * p);
}

}  // namespace steerstat
