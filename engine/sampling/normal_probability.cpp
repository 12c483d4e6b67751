#include "sampling/normal_probability.hpp"

#include <cmath>

#include "core/elementary.hpp"

namespace steerstat {
namespace {

constexpr double inverse_root_of_turn = 0x1.9884533d43651p-2;  // 1 / sqrt(2 pi)

double density(double z) {
  // An absolute error of z^2 / 2 is a relative one of its exponential: put back what rounding takes from z^2.
  const double square = z * z;
  if (square > 1600.0) return 0.0;  // below the smallest double
  const double rest = std::fma(z, z, -square);
  return inverse_root_of_turn * exponential(-0.5 * square) * (1.0 - 0.5 * rest);
}

/// P(0 < Z <= z): phi(z) (z + z^3/3 + z^5/(3 5) + ...), whose terms all have z's sign [Marsaglia 2004].
double central(double z) {
  double term = z;
  double sum = z;
  for (double odd = 3.0; std::abs(term) > 0x1p-60 * std::abs(sum); odd += 2.0) {
    term *= z * z / odd;
    sum += term;
  }
  return density(z) * sum;
}

/// P(Z > z) = phi(z) / (z + 1/(z + 2/(z + 3/(z + ...)))), z >= 1; the terms below suffice there.
double upper_tail(double z) {
  double fraction = z;
  for (double k = 500.0; k >= 1.0; k -= 1.0) fraction = z + k / fraction;
  return density(z) / fraction;
}

}  // namespace

double normal_probability(double z) {
  if (z <= -1.0) return upper_tail(-z);
  if (z >= 1.0) return 1.0 - upper_tail(z);
  return 0.5 + central(z);
}

}  // namespace steerstat
