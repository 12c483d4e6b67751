#pragma once

#include "control/controller.hpp"
#include "control/goal.hpp"
#include "control/phase.hpp"
#include "core/state.hpp"

namespace steerstat {

/// The align of the robust policy from state x: at full pace no longer than alignment.max_duration, so slow that |a|
/// starts below max_acceleration, and ended where |a| comes to it (README.md section 5).
Phase align_robustly(const State<double>& x, const Controller& controller, const Goal& goal);

/// Whether an align that has ended in state x is to go on at a slower pace: |a| is at its bound, or near it.
///
/// @param pace  the align's
bool aligns_too_fast(const State<double>& x, double pace, const Controller& controller, const Goal& goal);

}  // namespace steerstat
