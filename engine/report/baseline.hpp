#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "report/summary.hpp"
#include "statistics/proportion_drop.hpp"
#include "study/plan.hpp"
#include "study/study.hpp"

namespace steerstat {

/// What a summary says that a later run can be held against.
struct Baseline {
  std::string id, name, population_sha256, engine_version;
  std::uint64_t seed{0};
  ProportionCount converged{};  ///< of all cells
  struct Cell {
    std::vector<Plan::SweptValue> sweep;
    ProportionCount converged{};
  };
  std::vector<Cell> cells;  ///< of a study with sweeps
};

/// Reads a baseline from a summary (schemas/summary.schema.json); keys that it does not need are ignored.
/// @throws BadSpec with every mistake: not JSON, keys missing, an incomplete study, no trial, one scrambling of Sobol's
///         sequence
Baseline read_baseline(std::string_view summary_json);

/// Checks that the baseline's trials and the study's are of one population, so that their success rates compare: the
/// same plant, nominal plant, initial state, goal, horizon and convergence tolerances. The controller otherwise, the
/// number of trials and the seed may differ. A study with sweeps is held against a baseline of the same cells.
/// @throws BadUsage where they are not
void require_same_population(const Study& study, const Baseline& baseline);

/// Holds a summary against a baseline: adds the comparison and its gate. The gate fails where the success rate has
/// dropped significantly at the test's level, passes where a drop of the margin is ruled out at that level, and is
/// inconclusive where neither is so: too few trials, or one scrambling of Sobol's sequence.
///
/// With sweeps there is a gate for each cell. A drop in a cell is significant at the level over the number of cells
/// (Bonferroni), so that a run without drops fails with at most the level; a pass takes all cells, so that each rules
/// out the margin at the level itself [Berger 1982].
void judge_against(const Baseline& baseline, const BaselineTest& test, Summary& summary);

}  // namespace steerstat
