#pragma once

#include <cstdint>

#include "core/state.hpp"

namespace steerstat {

/// Why an integrator stopped.
enum class Cause : std::uint8_t {
  time = 0,     ///< the end of the interval came
  guard = 1,    ///< a guard fired
  failure = 2,  ///< the step size fell below 1e-12 s, or the integrator gave up
};

/// Where an integrator stopped.
struct Arrival {
  double t;             ///< [s]
  State<double> state;  ///< at t
  Cause cause;
};

/// A step shorter than this [s] is a failure.
inline constexpr double least_step = 1e-12;

/// The interpolant of one step.
class DenseOutput {
 public:
  virtual ~DenseOutput() = default;

  /// @param t  [s] within the step
  [[nodiscard]] virtual State<double> at(double t) const = 0;
};

/// Watches an integrator's steps; what it does changes nothing in the integration.
class StepObserver {
 public:
  virtual ~StepObserver() = default;

  /// A step covered [from, to] [s]; consecutive steps touch, and the last ends at the arrival.
  virtual void step(double from, double to, const DenseOutput& output) = 0;
};

}  // namespace steerstat
