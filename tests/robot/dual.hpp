#pragma once

#include <cmath>

/// Forward-mode automatic differentiation, for tests that derive what the sources state.
namespace steerstat::testing {

/// value + slope e with e^2 = 0. Nesting, Dual<Dual<T>>, gives higher derivatives.
template <class T>
struct Dual {
  T value{};
  T slope{};

  Dual() = default;
  // Implicit, so that the sources' Real(0.5) and the like work at any depth.
  Dual(double constant) : value(constant), slope(0.0) {}  // NOLINT(google-explicit-constructor)
  Dual(const T& v, const T& s) : value(v), slope(s) {}

  friend Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.slope + b.slope}; }
  friend Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.slope - b.slope}; }
  friend Dual operator-(const Dual& a) { return {-a.value, -a.slope}; }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.value * b.slope + a.slope * b.value};
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    return {a.value / b.value, (a.slope * b.value - a.value * b.slope) / (b.value * b.value)};
  }
};

inline double sine(double x) {
  return std::sin(x);
}
inline double cosine(double x) {
  return std::cos(x);
}
inline long double sine(long double x) {
  return std::sin(x);
}
inline long double cosine(long double x) {
  return std::cos(x);
}

template <class T>
Dual<T> cosine(const Dual<T>& x);

template <class T>
Dual<T> sine(const Dual<T>& x) {
  return {sine(x.value), cosine(x.value) * x.slope};
}

template <class T>
Dual<T> cosine(const Dual<T>& x) {
  return {cosine(x.value), -(sine(x.value) * x.slope)};
}

}  // namespace steerstat::testing
