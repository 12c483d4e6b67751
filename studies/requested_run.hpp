#pragma once

#include "exit_code.hpp"
#include "run_request.hpp"

namespace steerstat {

/// Runs a study of either kind, and keeps, reports and judges what it asks for.
///
/// @param ranks  this process leads; null where it is alone
/// @throws BadUsage, BadSpec before anything runs
ExitCode run_requested(const RunRequest& request, Ranks* ranks);

}  // namespace steerstat
