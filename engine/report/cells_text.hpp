#pragma once

#include <string>
#include <vector>

#include "report/summary.hpp"

namespace steerstat {

/// The cells of a swept study as a table, a row a cell: what is swept, the success rate, settling times and what the
/// failures died of. Of many cells it has the best and the worst by success rate.
///
/// @param cells   at least one
/// @param level   of the success rates' intervals
/// @param colour  use ANSI colours
std::string cells_text(const std::vector<Summary::Cell>& cells, double level, bool colour);

}  // namespace steerstat
