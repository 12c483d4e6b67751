#pragma once

#include "integrate/arrival.hpp"
#include "integrate/closed_loop.hpp"
#include "integrate/exertion.hpp"

namespace steerstat {

/// Measures the exertion of a phase step by step, on any integrator's dense output. Not thread-safe.
///
/// The effort is a quadrature of each step by Gauss and Legendre's rule, the peaks are searched inside it; what a step
/// is too long for is cut in parts. Both are right to far less than 1e-6 of their values on the dense output.
class ExertionMeter final : public StepObserver {
 public:
  /// @param t         the phase's start [s]
  /// @param exertion  of the course up to there; brought up to date step by step
  ExertionMeter(const ClosedLoop<double>& loop, const Phase& phase, double t, Exertion& exertion);

  void step(double from, double to, const DenseOutput& output) override;

 private:
  /// What is measured of one moment.
  struct Load {
    double acceleration, force, stroke;  ///< magnitudes
  };
  [[nodiscard]] Load load(double t, const State<double>& x) const;

  [[nodiscard]] int parts(double width, const State<double>& before, const State<double>& after) const;
  void measure(double from, double to, const DenseOutput& output);

  const ClosedLoop<double>& loop_;
  const Phase& phase_;
  double phase_start_;
  Exertion& exertion_;
};

}  // namespace steerstat
