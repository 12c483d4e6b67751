#pragma once

#include <optional>
#include <string>

#include "exit_code.hpp"
#include "study/approximation.hpp"

namespace steerstat {

/// Runs an approximation study, prints its tables and writes its summary where asked for.
///
/// @param summary  a file for the JSON summary, "-" for standard output in the tables' place; nothing for none
ExitCode run_approximation_study(const ApproximationStudy& study, const std::optional<std::string>& summary);

}  // namespace steerstat
