#pragma once

#include <vector>

#include "core/state.hpp"
#include "integrate/lockstep_integrator.hpp"
#include "robot/plant.hpp"

namespace steerstat {

/// A cycle (11) from a regular point of (5), the first joint at 0.
struct Cycle {
  double q2;         ///< [rad] sin 2 q2 != 0
  double q2_dot;     ///< [rad/s] != 0
  double amplitude;  ///< A [m] != 0
  double period;     ///< T [s] > 0
};

/// How far the nilpotent approximation (9) is from the robot in the second joint; in the first it is exact.
struct JointError {
  double position;  ///< [rad] |q2 - its approximation|
  double velocity;  ///< [rad/s] |q2_dot - its approximation|
  double state;     ///< norm of the two

  friend bool operator==(const JointError&, const JointError&) = default;
};

/// The error of the approximation in one cycle.
struct CycleError {
  JointError end;        ///< at the cycle's end, where (12) and (13) are used
  JointError worst;      ///< the largest of each within the cycle: what Fig. 2 shows
  double position_step;  ///< [1] error of q2 at the end over the change that (12) promises
  double velocity_step;  ///< [1] error of q2_dot at the end over the change that (13) promises

  friend bool operator==(const CycleError&, const CycleError&) = default;
};

/// Compares cycles of the exactly linearised robot (3)-(4), integrated, with the closed-form response of (9). Not
/// thread-safe: one a thread; what it computes depends on the arguments of each call alone.
class CycleComparison {
 public:
  /// @param plant      frictionless, true and believed
  /// @param tolerance  of the integration; the errors are right to about ten times it
  CycleComparison(const PlantParameters<double>& plant, double tolerance);

  /// @throws RunFailure where the integration fails
  CycleError error_of(const Cycle& cycle);

  /// The real second joint beside its approximation at one moment of a cycle.
  struct Moment {
    double t;  ///< [s]
    double q2, q2_dot;
    double approximate_q2, approximate_q2_dot;
  };

  /// The two at the ends of the cycle and at the multiples of T / samples between them, as Fig. 2 draws them.
  /// @return (samples + 1)
  std::vector<Moment> course_of(const Cycle& cycle, int samples);

 private:
  LockstepIntegrator integrator_;
  ClosedLoop<double> loop_;
  double coupling_;
};

}  // namespace steerstat
