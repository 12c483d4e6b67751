#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "control/cycle.hpp"
#include "integrate/closed_loop.hpp"

/// Closed loops whose motion is known exactly.
namespace steerstat::testing {

/// A loop whose controller knows its plant: q1'' = a to rounding.
inline ClosedLoop<double> exact_loop(double kp = 7.0, double kd = 5.0) {
  const PlantConstants<double> plant = constants_of(PlantParameters<double>{});
  return {plant, plant, kp, kd, 0.0};
}

/// A loop whose controller takes link 2 for a point on its axis, so that it leaves the plant alone while drifting.
inline ClosedLoop<double> free_loop(const PlantParameters<double>& plant) {
  PlantConstants<double> nominal = constants_of(PlantParameters<double>{});
  nominal.moment = 0.0;
  return {constants_of(plant), nominal, 7.0, 5.0, 0.0};
}

/// Align on an exact loop with goal 0 and kp = decay^2 + frequency^2, kd = 2 decay: q1 is a damped oscillator.
struct Oscillator {
  double decay;      // [1/s]
  double frequency;  // [rad/s]

  [[nodiscard]] ClosedLoop<double> loop() const {
    return exact_loop(decay * decay + frequency * frequency, 2.0 * decay);
  }

  /// From q1 = 1 at rest, t [s] later: q1 and q1_dot.
  [[nodiscard]] std::array<double, 2> at(double t) const {
    const double envelope = std::exp(-decay * t);
    const double c = std::cos(frequency * t);
    const double s = std::sin(frequency * t);
    return {envelope * (c + decay / frequency * s),
            -envelope * (decay * decay + frequency * frequency) / frequency * s};
  }

  [[nodiscard]] double active_error(double t) const {
    const auto [e, v] = at(t);
    return std::sqrt(e * e + v * v);
  }

  /// The time of the k-th turning point, where q1_dot = 0; for kp > 1 the active error has a minimum there.
  [[nodiscard]] double turning_point(int k) const { return k * 3.14159265358979323846 / frequency; }
};

/// The first time in (from, to] at which `g` goes from positive to non-positive, by samples and bisection; `to` where
/// there is none. Dips shorter than `spacing` go unseen.
template <class Function>
double first_descent_by_samples(const Function& g, double from, double to, double spacing) {
  const auto samples = static_cast<long>((to - from) / spacing);
  for (long i = 1; i <= samples; ++i) {
    double low = from + static_cast<double>(i - 1) * spacing;
    double high = from + static_cast<double>(i) * spacing;
    if (!(g(low) > 0.0 && g(high) <= 0.0)) continue;
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = 0.5 * (low + high);
      (g(middle) > 0.0 ? low : high) = middle;
    }
    return high;
  }
  return to;
}

/// q1 and q1_dot during a cycle (11) on an exact loop, from q1 = 0 at rest.
inline std::array<double, 2> cycle_motion(double amplitude, double period, double t) {
  const double lambda = t / period;
  double position = 0.0;
  double velocity = 0.0;
  for (std::size_t k = cycle_coefficients.size(); k >= 1; --k) {
    const double power = static_cast<double>(k);
    const double c = cycle_coefficients[k - 1];
    position += c / ((power + 1.0) * (power + 2.0)) * std::pow(lambda, power + 2.0);
    velocity += c / (power + 1.0) * std::pow(lambda, power + 1.0);
  }
  return {amplitude * position, amplitude / period * velocity};
}

}  // namespace steerstat::testing
