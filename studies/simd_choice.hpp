#pragma once

#include <string>

#include "core/instruction_set.hpp"

namespace steerstat {

/// The instruction set called `name`.
/// @throws BadUsage where there is none of that name or this machine does not run it, naming those that it runs
InstructionSet choose_simd(const std::string& name);

/// The instruction sets this program was built for, and which of them it uses here.
std::string simd_text();

}  // namespace steerstat
