#pragma once

#include "exit_code.hpp"

namespace steerstat {

/// Says on standard error what the exception that is being handled has to say. Only within a catch clause.
///
/// @return the exit code that goes with it
ExitCode tell_failure() noexcept;

}  // namespace steerstat
