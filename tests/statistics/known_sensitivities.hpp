#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <vector>

/// Functions of uniform inputs whose Sobol' indices have closed forms.
namespace steerstat::testing_statistics {

struct KnownSensitivities {
  std::function<double(std::span<const double>)> function;  ///< of inputs in [0, 1)
  std::vector<double> first_order, total;                   ///< (inputs)
  [[nodiscard]] std::size_t inputs() const { return first_order.size(); }
};

/// sin a + 7 sin^2 b + 0.1 c^4 sin a, each on (-pi, pi), and an input without effect [Ishigami and Homma 1990].
inline KnownSensitivities ishigami() {
  constexpr double pi = 3.141592653589793;
  const double pi4 = std::pow(pi, 4);
  const double v1 = 0.5 * std::pow(1.0 + 0.1 * pi4 / 5.0, 2);
  const double v2 = 49.0 / 8.0;
  const double v13 = 0.01 * pi4 * pi4 * (1.0 / 18.0 - 1.0 / 50.0);
  const double v = v1 + v2 + v13;
  return {[](std::span<const double> u) {
            const double a = pi * (2.0 * u[0] - 1.0);
            const double b = pi * (2.0 * u[1] - 1.0);
            const double c = pi * (2.0 * u[2] - 1.0);
            return std::sin(a) + 7.0 * std::pow(std::sin(b), 2) + 0.1 * std::pow(c, 4) * std::sin(a);
          },
          {v1 / v, v2 / v, 0.0, 0.0},
          {(v1 + v13) / v, v2 / v, v13 / v, 0.0}};
}

/// The product of (|4 u - 2| + a) / (1 + a), with a = 0, 1, 4.5, 9, 99, 99 [Sobol' 1993, Saltelli 2010].
inline KnownSensitivities g_function() {
  static const std::vector<double> a{0.0, 1.0, 4.5, 9.0, 99.0, 99.0};
  KnownSensitivities known;
  known.function = [](std::span<const double> u) {
    double product = 1.0;
    for (std::size_t i = 0; i < a.size(); ++i) product *= (std::abs(4.0 * u[i] - 2.0) + a[i]) / (1.0 + a[i]);
    return product;
  };
  double all = 1.0;
  for (const double ai : a) all *= 1.0 + 1.0 / (3.0 * (1.0 + ai) * (1.0 + ai));
  for (const double ai : a) {
    const double vi = 1.0 / (3.0 * (1.0 + ai) * (1.0 + ai));
    known.first_order.push_back(vi / (all - 1.0));
    known.total.push_back(vi * all / (1.0 + vi) / (all - 1.0));
  }
  return known;
}

/// A success: 1 above both cliffs, 0.4931 in the first input and 0.2 in the second; a third has no effect.
inline KnownSensitivities cliffs() {
  const double p = 0.5069;
  const double q = 0.8;
  const double v = p * q * (1.0 - p * q);
  const double v1 = q * q * p * (1.0 - p);
  const double v2 = p * p * q * (1.0 - q);
  return {[](std::span<const double> u) { return u[0] > 0.4931 && u[1] > 0.2 ? 1.0 : 0.0; },
          {v1 / v, v2 / v, 0.0},
          {(v - v2) / v, (v - v1) / v, 0.0}};
}

/// Draws of the unit cube, the same for the same seed with every standard library.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : generator_(seed) {}
  double next() { return (static_cast<double>(generator_() >> 12U) + 0.5) * 0x1p-52; }
  std::vector<double> point(std::size_t inputs) {
    std::vector<double> u(inputs);
    for (double& x : u) x = next();
    return u;
  }

 private:
  std::mt19937_64 generator_;
};

/// How often intervals covered, and what their estimates came to.
struct Simulation {
  double repeats{0.0}, covered{0.0}, sum{0.0}, squares{0.0}, half_widths{0.0};

  template <class Index>
  void add(const Index& index, double truth) {
    // A width of 0 has only the rounding of the estimate to cover with.
    covered += index.low - 1e-12 <= truth && truth <= index.high + 1e-12 ? 1.0 : 0.0;
    sum += index.estimate;
    squares += index.estimate * index.estimate;
    half_widths += (index.high - index.low) / 2.0;
    repeats += 1.0;
  }
  [[nodiscard]] double coverage() const { return covered / repeats; }
  [[nodiscard]] double mean() const { return sum / repeats; }
  [[nodiscard]] double spread() const { return std::sqrt(std::max(squares / repeats - mean() * mean(), 0.0)); }
  [[nodiscard]] double standard_error_of_mean() const { return spread() / std::sqrt(repeats); }
  /// The standard error that the intervals claim, at level 0.95.
  [[nodiscard]] double claimed() const { return half_widths / repeats / 1.959963984540054; }
};

/// Least coverage that so many repeats may show of intervals at level 0.95: four standard errors below.
inline double least_coverage(double repeats) {
  return 0.95 - 4.0 * std::sqrt(0.95 * 0.05 / repeats);
}

}  // namespace steerstat::testing_statistics
