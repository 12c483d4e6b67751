#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "study/audit.hpp"
#include "study/for_each.hpp"
#include "study/plan.hpp"
#include "study/run.hpp"
#include "study/study.hpp"
#include "study/trial_table.hpp"

namespace steerstat {

/// Trajectories of trials that have run, replayed: those that the study retains.
///
/// @param trials  as the study stores
/// @throws RunGivenUp, std::logic_error where a replay ends differently from its run
std::vector<StudyResult::Retained> retained_trajectories(const Study& study, const Plan& plan, const TrialTable& trials,
                                                         const RunOptions& options, const ForEach& for_each);

/// The indices of trials to audit. @param trials  those that have run, all rows
std::vector<std::uint64_t> trials_to_audit(const Study& study, const TrialTable& trials);

/// Computes trials of the run again with the reference integrator. After a stop request no further one is begun.
/// @throws RunGivenUp
Audit audit_of(const Study& study, const Plan& plan, std::span<const std::uint64_t> indices, const RunOptions& options,
               const ForEach& for_each);

}  // namespace steerstat
