#pragma once

#include <cstdint>
#include <optional>

#include "core/instruction_set.hpp"
#include "distributed/ranks.hpp"
#include "store/study_directory.hpp"
#include "study/run.hpp"

namespace steerstat {

/// What several ranks have finished together.
struct RankedRun {
  FinishedTrials finished;  ///< all that is known, earlier trials too; the time is that on the leader's clock
  unsigned threads{0};      ///< of all ranks
  std::optional<InstructionSet> simd;  ///< the least of any rank, with lockstep
  std::vector<SetAside> set_aside;     ///< shards that were found damaged; the trials in them are missing
};

/// How ranks share a study.
struct Sharing {
  /// Whether outcomes are sent to the leader, who writes them, instead of each rank writing its own into the study's
  /// directory. Without a directory they are sent in any case, and so are sketches, to be added up as they come.
  bool gather{false};
  /// [s] of work that a rank is given at a time: what the leader does for each asks for longer ones, and what is lost
  /// where a rank dies for shorter ones. Nothing: as usual_seconds_a_range() has it.
  std::optional<double> seconds_a_range{};
};

/// [s] Two; of more than 100 ranks longer, so that they ask no more than 50 times a second together. @param ranks  > 0
double usual_seconds_a_range(int ranks);

/// Leads the ranks through a study, and works with them on a thread of its own: deals out what is missing until all is
/// finished, the study's rule stops it or a stop is requested. Called on rank 0; others work().
///
/// @param options    progress, stop, threads and simd are heeded
/// @param earlier    trials that need not run again
/// @param directory  begun: takes every finished trial; null: none are kept
/// @throws RunFailure with what failed first on any rank, once no rank works any more. The ranks then wait for another
///         study or their end, as they do after a run that went well.
RankedRun run_on_ranks(Ranks& ranks, const Study& study, const RunOptions& options, FinishedTrials earlier,
                       StudyDirectory* directory, const Sharing& sharing);

/// What run_study() would have left: heeds the study's rule, retains trajectories and audits, on the leader alone. Runs
/// what is still missing, but for a stop.
StudyResult completed(const Study& study, const RunOptions& options, RankedRun ranked);

/// Sends all other ranks out of work() with an exit code. Called on rank 0.
void end_ranks(Ranks& ranks, int exit_code);

}  // namespace steerstat
