#pragma once

#include <functional>

#include "study/plan.hpp"
#include "study/run.hpp"
#include "study/study.hpp"
#include "study/trial_range.hpp"
#include "study/trial_sketch.hpp"

namespace steerstat {

/// What a run of a study that does not keep all rows stands on.
struct SketchedRunMeans {
  /// Runs trials of a range, from its first one on without a gap: all, or fewer after a stop request. Their rows are
  /// counted from the range's first trial. The last argument is an empty table whose memory they are put into: one that
  /// every piece is freed from and another one allocated for, of another size, leaves holes that add up.
  std::function<StudyResult(TrialRange, const RunOptions&, TrialTable)> run_piece;
  ForEach for_each;
};

/// Runs a range of a study's trials piece by piece, each some second's work, and keeps of each what the study stores.
/// In memory are the rows of one piece, the sketch and the rows kept, however many trials there are. Which trials make
/// a piece depends on how quick the machine is, and changes nothing of the result.
///
/// Its sink is given pieces, at least a tenth of a second and at most ten apart, and is shown no slots.
///
/// @param range    whole draws
/// @param earlier  trials of the study that need not run again, whole draws
/// @param result   with threads and simd; is given rows, sketch and time
/// @return whether every trial of the range is there, or every one up to where the study's rule stopped it
bool run_sketched(const Study& study, const Plan& plan, TrialRange range, const RunOptions& options,
                  FinishedTrials earlier, const SketchedRunMeans& means, StudyResult& result);

/// Of a study that has finished: brings the rows of trials to be retained and audited into the result, computed again
/// where they were not kept, and drops those that a run of just this study would not have kept.
/// @return the indices of the trials to audit
std::vector<std::uint64_t> complete_rows(const Study& study, const Plan& plan, const RunOptions& options,
                                         const ForEach& for_each, StudyResult& result);

}  // namespace steerstat
