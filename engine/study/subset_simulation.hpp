#pragma once

#include "statistics/subset_levels.hpp"
#include "study/run.hpp"
#include "study/study.hpp"
#include "study/trial_table.hpp"

namespace steerstat {

/// How badly a trial performed, for the levels of a subset simulation: the time it took to converge [s], and infinity
/// where it did not. It exceeds the horizon exactly where the trial failed; what is beyond has no order, as levels end
/// there.
double performance(const TrialOutcome& outcome);

/// What a subset simulation leaves: its trials, in the order in which they were evaluated.
struct SubsetRun {
  Study study;  ///< with the trials' values listed, so that its Plan has them
  StudyResult result;
};

/// Runs a study by subset simulation: the trials of a step of all chains side by side, as run_study() does. The trials
/// are the same bits whatever the number of threads. The first level's are those of plain Monte Carlo sampling.
///
/// Trials follow from those before, so that no part of the run can be run elsewhere, or resumed.
///
/// @return not complete, and without trials, where a stop was requested
/// @throws as run_study()
SubsetRun run_subset_simulation(const Study& study, const RunOptions& options);

/// The levels that the trials of a finished run belong to. @throws std::invalid_argument where they are of no such run
SubsetLevels subset_levels(const Study& study, const TrialTable& trials);

}  // namespace steerstat
