#pragma once

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "closed_forms.hpp"
#include "integrate/arrival.hpp"
#include "integrate/closed_loop.hpp"

/// What the suites of tests that all integrators share stand on.
namespace steerstat::testing {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// The errors of a phase of some seconds, of states of size 1, may add up to this many tolerances.
inline constexpr double error_growth = 20.0;

/// How near a guard is located on the dense output [s].
inline constexpr double guard_precision = 1e-10;

inline Phase align_phase(double active_tolerance) {
  Phase phase;
  phase.kind = PhaseKind::align;
  phase.active_tolerance = active_tolerance;
  return phase;
}

inline Phase drift_phase(double low, double high) {
  Phase phase;
  phase.kind = PhaseKind::drift;
  phase.q2_low = low;
  phase.q2_high = high;
  return phase;
}

inline Phase cycle_phase(double amplitude, double period) {
  Phase phase;
  phase.kind = PhaseKind::swing;
  phase.amplitude = amplitude;
  phase.duration = period;
  return phase;
}

inline std::array<std::uint64_t, 5> bits_of(const Arrival& a) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return {bits(a.t), bits(a.state.q1), bits(a.state.q2), bits(a.state.q1_dot), bits(a.state.q2_dot)};
}

/// The largest difference of a field.
inline double distance(const State<double>& a, const State<double>& b) {
  return std::max(std::max(std::abs(a.q1 - b.q1), std::abs(a.q2 - b.q2)),
                  std::max(std::abs(a.q1_dot - b.q1_dot), std::abs(a.q2_dot - b.q2_dot)));
}

/// Keeps each step's ends, and the states in its middle and at its ends.
struct StepRecorder final : StepObserver {
  struct Sample {
    double t;
    State<double> state;
  };
  std::vector<std::array<double, 2>> steps;
  std::vector<Sample> samples;

  void step(double from, double to, const DenseOutput& output) override {
    steps.push_back({from, to});
    for (const double t : {from, 0.5 * (from + to), to}) samples.push_back({t, output.at(t)});
  }
};

template <class Integrator>
class IntegratorTest : public ::testing::Test {
 protected:
  static Arrival advance(const ClosedLoop<double>& loop, const Phase& phase, double t0, const State<double>& x0,
                         double t_end, double tolerance = 1e-9) {
    return Integrator(tolerance).advance(loop, phase, t0, x0, t_end);
  }

  /// The oscillator's state at t, with link 2 somewhere.
  static State<double> state_of(const Oscillator& oscillator, double t) {
    const auto [e, v] = oscillator.at(t);
    return {e, 0.7, v, 0.1};
  }
};

}  // namespace steerstat::testing
