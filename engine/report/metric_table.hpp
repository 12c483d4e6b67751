#pragma once

#include <string>

#include "report/summary.hpp"

namespace steerstat {

/// What the trials' metrics say, as tables for a terminal: of the converged trials when they settled and after how many
/// cycles, of all what they asked of the first joint, and how their cycles contracted. Metrics that no trial has are
/// left out; nothing is left where there are none.
std::string metric_tables(const TrialStatistics& statistics, bool colour);

}  // namespace steerstat
