#pragma once

#include <nlohmann/json.hpp>

#include "study/reader_json.hpp"
#include "study/study.hpp"

namespace steerstat {

/// The confidence levels that a spec may ask for.
inline constexpr Range confidence_levels{
    .low = 0.5, .high = 0.999999, .includes_low = true, .includes_high = true, .rule = "in [0.5, 0.999999]"};

/// Decodes a spec's `intervals`.
///
/// @param stops  whether the study stops on precision: its intervals must then hold at a number of trials that was
///               decided by looking, and are confidence sequences
/// @return with defaults where mistakes were noted
IntervalChoice decode_intervals(const Reader& reader, bool stops);

/// What of the choice is not the default, as a spec writes it; null where all is.
nlohmann::json encode_intervals(const IntervalChoice& intervals, bool stops);

}  // namespace steerstat
