#pragma once

#include <cstdint>

namespace steerstat::bench {

/// Arithmetic of one lane in one step: sums, products and quotients count for one, fused multiply-adds for two.
struct Operations {
  std::uint64_t in_double;
  std::uint64_t in_single;
};

struct StepOperations {
  Operations series;  ///< the Taylor expansion alone
  Operations step;    ///< all of the step, the series included
};

/// Counts the lockstep kernel's operations by running its own formulas on a type that counts.
///
/// @param in_double  coefficients in double precision, the rest being in single; a precision the kernel is built for
StepOperations count_operations(int in_double);

}  // namespace steerstat::bench
