#pragma once

#include "exit_code.hpp"

namespace steerstat {

/// The program `steerstat`: reads the command line, does what it says, and reports what went wrong on standard error.
/// Throws nothing.
ExitCode run_program(int argc, const char* const* argv) noexcept;

}  // namespace steerstat
