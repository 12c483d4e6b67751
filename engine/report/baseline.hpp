#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "report/summary.hpp"
#include "statistics/proportion_drop.hpp"
#include "study/study.hpp"

namespace steerstat {

/// What a summary says that a later run can be held against.
struct Baseline {
  std::string id, name, population_sha256, engine_version;
  std::uint64_t seed{0};
  ProportionCount converged{};
};

/// Reads a baseline from a summary (schemas/summary.schema.json); keys that it does not need are ignored.
/// @throws BadSpec with every mistake: not JSON, keys missing, an incomplete study, no trial, several cells
Baseline read_baseline(std::string_view summary_json);

/// Checks that the baseline's trials and the study's are of one population, so that their success rates compare: the
/// same plant, nominal plant, initial state, goal, horizon and convergence tolerances. The controller otherwise, the
/// number of trials and the seed may differ.
/// @throws BadUsage where they are not, or where the study has several cells
void require_same_population(const Study& study, const Baseline& baseline);

/// Holds a summary against a baseline: adds the comparison and its gate. The gate fails where the success rate has
/// dropped significantly at the test's level, passes where a drop of the margin is ruled out at that level, and is
/// inconclusive where neither is so: too few trials.
void judge_against(const Baseline& baseline, const BaselineTest& test, Summary& summary);

}  // namespace steerstat
