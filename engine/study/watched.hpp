#pragma once

#include <cstdint>
#include <optional>

#include "study/precision_watch.hpp"
#include "study/run.hpp"
#include "study/study.hpp"
#include "study/trial_sketch.hpp"
#include "study/trial_table.hpp"

namespace steerstat {

/// A watch that has seen nothing of the study yet. @pre the study has a rule
PrecisionWatch watch_of(const Study& study);

/// What the study's rule makes of its finished trials: of those from index 0 up to the first gap. Nothing without a
/// rule.
std::optional<StopReport> watched(const Study& study, const TrialTable& trials);

/// The same of a study that does not keep all rows. @param sketch  of all trials up to some index
std::optional<StopReport> watched(const Study& study, const TrialSketch& sketch);

/// Whichever of the two there is of a result.
std::optional<StopReport> watched(const Study& study, const StudyResult& result);

/// How many trials a finished run of the study leaves: all, or as many as its rule let it take before it stopped.
/// @param trials  those that it left
std::uint64_t trials_due(const Study& study, const TrialTable& trials);
std::uint64_t trials_due(const Study& study, const StudyResult& result);

}  // namespace steerstat
