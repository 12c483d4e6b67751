#pragma once

#include <optional>

#include "core/instruction_set.hpp"

namespace steerstat::bench {

/// What one core does at most [operations/s], a fused multiply-add counting for two.
struct FmaPeak {
  double in_double;
  double in_single;
};

/// Measures the peak with independent chains of fused multiply-adds, the best of several attempts by CPU time. Nothing
/// for the portable set, whose fused multiply-add is a library call.
std::optional<FmaPeak> measure_fma_peak(InstructionSet set);

}  // namespace steerstat::bench
