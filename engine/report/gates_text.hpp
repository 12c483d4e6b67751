#pragma once

#include <string>
#include <vector>

#include "report/verdict.hpp"

namespace steerstat {

/// The verdicts as a table for a terminal. Of more than 30 gates those that passed are only counted, and the first 30
/// others shown.
///
/// @param colour  use ANSI colours
std::string gates_text(const std::vector<GateVerdict>& gates, bool colour);

}  // namespace steerstat
