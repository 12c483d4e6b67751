#include "sampling/normal_probability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/elementary.hpp"

namespace steerstat {
namespace {

constexpr double inverse_root_of_turn = 0x1.9884533d43651p-2;  // 1 / sqrt(2 pi)

/// exp(-z^2 / 2) times scale.
double bell(double z, double scale) {
  // An absolute error of z^2 / 2 is a relative one of its exponential: put back what rounding takes from z^2.
  const double square = z * z;
  if (square > 1600.0) return 0.0;  // below the smallest double
  const double rest = std::fma(z, z, -square);
  return scale * exponential(-0.5 * square) * (1.0 - 0.5 * rest);
}

double density(double z) {
  return bell(z, inverse_root_of_turn);
}

// Coefficients of [Cody 1969] as in his later ANORM, highest order first: of P(0 < Z <= z) / z in z^2, |z| <= 0.66291,
constexpr std::array central_numerator{0.065682337918207449113, 2.2352520354606839287, 161.02823106855587881,
                                       1067.6894854603709582, 18154.981253343561249};
constexpr std::array central_denominator{1.0, 47.20258190468824187, 976.09855173777669322, 10260.932208618978205,
                                         45507.789335026729956};
// of P(Z > z) / exp(-z^2 / 2) in z up to sqrt 32,
constexpr std::array middle_numerator{1.0765576773720192317e-8, 0.39894151208813466764, 8.8831497943883759412,
                                      93.506656132177855979,    597.27027639480026226,  2494.5375852903726711,
                                      6848.1904505362823326,    11602.651437647350124,  9842.7148383839780218};
constexpr std::array middle_denominator{1.0,
                                        22.266688044328115691,
                                        235.38790178262499861,
                                        1519.377599407554805,
                                        6485.558298266760755,
                                        18615.571640885098091,
                                        34900.952721145977266,
                                        38912.003286093271411,
                                        19685.429676859990727};
// and of what 1 / sqrt(2 pi) exceeds z P(Z > z) / exp(-z^2 / 2) by, times z^2, in 1 / z^2 beyond.
constexpr std::array tail_numerator{0.02307344176494017303, 0.21589853405795699,     0.1274011611602473639,
                                    0.022235277870649807,   0.001421619193227893466, 2.9112874951168792e-5};
constexpr std::array tail_denominator{1.0,
                                      1.28426009614491121,
                                      0.468238212480865118,
                                      0.0659881378689285515,
                                      0.00378239633202758244,
                                      7.29751555083966205e-5};

template <std::size_t n>
double polynomial(const std::array<double, n>& coefficients, double x) {
  double sum = coefficients[0];
  for (std::size_t i = 1; i < n; ++i) sum = std::fma(sum, x, coefficients[i]);
  return sum;
}

double quick_upper_tail(double z) {
  if (z <= 0x1.6a09e667f3bcdp+2) {  // sqrt 32
    return bell(z, polynomial(middle_numerator, z) / polynomial(middle_denominator, z));
  }
  const double x = 1.0 / (z * z);
  const double excess = x * polynomial(tail_numerator, x) / polynomial(tail_denominator, x);
  return bell(z, (inverse_root_of_turn - excess) / z);
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
  for (int k = 500; k >= 1; --k) fraction = z + k / fraction;
  return density(z) / fraction;
}

}  // namespace

double normal_probability(double z) {
  if (z <= -1.0) return upper_tail(-z);
  if (z >= 1.0) return 1.0 - upper_tail(z);
  return 0.5 + central(z);
}

double quick_normal_probability(double z) {
  if (std::abs(z) <= 0.66291) {
    const double square = z * z;
    return 0.5 + z * (polynomial(central_numerator, square) / polynomial(central_denominator, square));
  }
  return z < 0.0 ? quick_upper_tail(-z) : 1.0 - quick_upper_tail(z);
}

double coordinate_of_normal(double z) {
  constexpr double least = 0x1p-53;
  return std::clamp(quick_normal_probability(z), least, 1.0 - least);
}

}  // namespace steerstat
