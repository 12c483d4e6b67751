#pragma once

#include <string>

#include "report/rare_failures.hpp"

namespace steerstat {

/// "1.23e-05, 95 % interval 1.1e-05 to 1.4e-05 (Fay and Feuer)".
std::string failure_rate_text(const RareFailures& rare);

/// What a summary says of rare failures instead of a table of outcomes: lines for a terminal.
std::string rare_failures_text(const RareFailures& rare, bool colour);

}  // namespace steerstat
