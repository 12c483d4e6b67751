#include "integrate/descent.hpp"

#include <array>
#include <cassert>

namespace steerstat {
namespace {

constexpr int deepest = 50;  // halvings; then an interval is as short as rounding

double value(std::span<const double> coefficients, double x) {
  double sum = 0.0;
  for (std::size_t k = coefficients.size(); k-- > 0;) sum = sum * x + coefficients[k];
  return sum;
}

/// Bernstein coefficients of a polynomial on a subinterval of [0, 1].
struct Bernstein {
  std::size_t degree;
  std::array<double, highest_degree + 1> b;

  [[nodiscard]] bool starts_positive() const { return b[0] > 0.0; }

  /// Bounds the number of roots inside, counting 0 as negative.
  [[nodiscard]] int sign_changes() const {
    int changes = 0;
    for (std::size_t i = 0; i < degree; ++i) changes += (b[i] > 0.0) != (b[i + 1] > 0.0) ? 1 : 0;
    return changes;
  }
};

/// From powers on [0, 1]: b_i = sum over k of C(i, k) / C(n, k) a_k [Farouki 2012].
Bernstein bernstein(std::span<const double> a) {
  Bernstein p{a.size() - 1, {}};
  double binomial = 1.0;
  for (std::size_t k = 0; k <= p.degree; ++k) {
    p.b[k] = a[k] / binomial;
    binomial = binomial * static_cast<double>(p.degree - k) / static_cast<double>(k + 1);
  }
  for (std::size_t j = 1; j <= p.degree; ++j) {
    for (std::size_t i = p.degree; i >= j; --i) p.b[i] += p.b[i - 1];
  }
  return p;
}

/// Cuts `p` in the middle by de Casteljau's algorithm; p becomes the left half. @return the right half
Bernstein split(Bernstein& p) {
  Bernstein right{p.degree, {}};
  for (std::size_t j = 0; j <= p.degree; ++j) {
    right.b[p.degree - j] = p.b[p.degree];
    for (std::size_t i = p.degree; i > j; --i) p.b[i] = 0.5 * (p.b[i - 1] + p.b[i]);
  }
  return right;
}

/// The crossing between low, where the polynomial is positive, and high, where it is not; the only one there.
double bisect(std::span<const double> coefficients, double low, double high) {
  for (double middle = 0.5 * (low + high); low < middle && middle < high; middle = 0.5 * (low + high)) {
    (value(coefficients, middle) > 0.0 ? low : high) = middle;
  }
  return high;
}

/// first_descent() on [low, high], where the polynomial is `p`.
std::optional<double> search(std::span<const double> coefficients, Bernstein p, double low, double high, int depth,
                             bool& armed) {
  if (armed && !p.starts_positive()) return low;
  armed = armed || p.starts_positive();
  const int changes = p.sign_changes();
  if (changes == 0) return std::nullopt;
  if (changes == 1) {
    if (p.starts_positive()) return bisect(coefficients, low, high);
    armed = true;
    return std::nullopt;
  }
  if (depth == deepest) return armed ? std::optional(low) : std::nullopt;
  const double middle = 0.5 * (low + high);
  const Bernstein right = split(p);
  if (const auto crossing = search(coefficients, p, low, middle, depth + 1, armed)) return crossing;
  return search(coefficients, right, middle, high, depth + 1, armed);
}

}  // namespace

std::optional<double> first_descent(std::span<const double> coefficients, bool& armed) {
  assert(!coefficients.empty() && coefficients.size() <= highest_degree + 1);
  return search(coefficients, bernstein(coefficients), 0.0, 1.0, 0, armed);
}

}  // namespace steerstat
