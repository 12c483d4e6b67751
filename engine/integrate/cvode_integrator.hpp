#pragma once

#include <memory>

#include "integrate/arrival.hpp"
#include "integrate/closed_loop.hpp"
#include "integrate/exertion.hpp"

namespace steerstat {

/// The reference integrator: SUNDIALS CVODE [Hindmarsh 2005], Adams-Moulton of order 1 to 12 with fixed-point
/// iteration.
///
/// Slow and trusted: it shares the plant's equations with the other engines, but neither their method nor their sine.
/// Not thread-safe, one object a thread; objects share nothing. Allocates on construction alone. What it computes
/// depends on the arguments of each call alone, not on the calls before.
class CvodeIntegrator {
 public:
  /// @param tolerance  > 0. CVODE's relative tolerance is a hundredth of it, the absolute ones are a twentieth and, for
  ///   q2_dot, a hundredth, none below 1e-15; where rounding makes a phase's steps shrink below 1e-12 s, it goes on
  ///   with tolerances ten times as large, up to a thousand times, before it fails. With 1e-9, settling times of
  ///   perturbed trials are right to 1e-6 s (median), as a test holds.
  /// @throws RunFailure where SUNDIALS cannot be set up
  explicit CvodeIntegrator(double tolerance);
  ~CvodeIntegrator();
  CvodeIntegrator(CvodeIntegrator&&) noexcept;
  CvodeIntegrator& operator=(CvodeIntegrator&&) noexcept;

  /// Advances the closed loop through one phase, to t_end or to the first guard of `phase` that fires.
  ///
  /// Guards fire as Phase says, at their first crossing on the dense output, located to 1e-10 s or better; a dip within
  /// one step is found however short. At t_end itself the end time and the state are exact, not interpolated.
  ///
  /// @param t0, t_end  [s]; t_end <= t0 (or not a number) arrives at once
  /// @param x0         state at t0; where it is not finite, the integration fails at t0
  /// @param observer   sees every step; may be null
  /// @param exertion   of the course so far, brought up to date; null where nobody asks
  /// @return where it stopped, and why; never throws
  Arrival advance(const ClosedLoop<double>& loop, const Phase& phase, double t0, const State<double>& x0, double t_end,
                  StepObserver* observer = nullptr, Exertion* exertion = nullptr);

 private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace steerstat
