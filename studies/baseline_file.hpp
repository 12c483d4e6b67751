#pragma once

#include <string>

#include "report/baseline.hpp"

namespace steerstat {

/// Reads the summary that a run is held against.
///
/// @param name  the file, or "-" for standard input
/// @throws BadUsage where the file cannot be read, or with everything that is amiss with the summary, one a line
Baseline read_baseline_file(const std::string& name);

}  // namespace steerstat
