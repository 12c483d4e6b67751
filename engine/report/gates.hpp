#pragma once

#include <vector>

#include "report/summary.hpp"
#include "report/verdict.hpp"
#include "study/plan.hpp"
#include "study/run.hpp"
#include "study/study.hpp"

namespace steerstat {

/// Judges a study's gates, in the spec's order; those on cells once in each of their cells, in the cells' order.
///
/// Intervals are of the level that the study chose: by its method for rates; by order statistics for
/// quantiles, as a confidence sequence where the rates' is one; by Student's t for means, which has no such form. Over
/// all cells of a sweep they count draws; see Independence for what each sampling leaves independent.
///
/// @param result   what the summary is of
/// @param summary  with its statistics, overall and by cell
std::vector<GateVerdict> judge_gates(const Study& study, const Plan& plan, const StudyResult& result,
                                     const Summary& summary);

}  // namespace steerstat
