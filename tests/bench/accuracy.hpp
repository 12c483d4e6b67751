#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "trial/trial.hpp"
#include "workload.hpp"

namespace steerstat::bench {

/// How far outcomes are from those of a reference.
struct Accuracy {
  double settling_error{0.0};  ///< [s] median |difference of settling times| where both have one and agree
  std::size_t agreeing{0};     ///< trials with the reference's status and counts
  std::size_t trials{0};
};

Accuracy accuracy_of(std::span<const TrialOutcome> outcomes, std::span<const TrialOutcome> reference);

/// A method at the coarsest tolerance that is accurate enough.
struct Calibrated {
  double tolerance;
  Accuracy accuracy;
};

/// Bisects for the coarsest tolerance, to a tenth of a decade, at which the method's median error in settling time is
/// at most `wanted` [s]; the finest, 1e-13, where there is none.
Calibrated calibrate(const std::function<MakeRunner(double tolerance)>& method, std::span<const TrialOutcome> reference,
                     double wanted);

}  // namespace steerstat::bench
