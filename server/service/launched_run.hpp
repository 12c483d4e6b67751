#pragma once

#include "service/kept_run.hpp"
#include "service/launcher.hpp"
#include "store/study_directory.hpp"

namespace steerstat {

/// Runs what is left of a study through a launcher, into the study's own directory, and follows it there: its progress
/// by the shards that appear, its trials by what these hold. Where an earlier process has launched it and it still
/// runs, follows that. On a stop request it is sent SIGTERM, keeps what is finished and ends.
///
/// @param directory  of the study, begun: what is finished there is not run again
/// @return whether the study's result is in place
/// @throws RunFailure saying how the launcher failed, with the last of what it said
bool run_launched(const KeptRun& run, const Launcher& launcher, StudyDirectory& directory);

}  // namespace steerstat
