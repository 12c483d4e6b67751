#pragma once

#include <span>

#include "core/instruction_set.hpp"

namespace steerstat::testing {

/// The functions of packs that the tests look at, lane by lane.
enum class PackFunction { sine, cosine, coarse_log2, coarse_exp2, narrowed, square_root };

/// Evaluates `function` on the packs of `set`. @param in, out  the same size, a multiple of 16
void evaluate(InstructionSet set, PackFunction function, std::span<const double> in, std::span<double> out);

}  // namespace steerstat::testing
