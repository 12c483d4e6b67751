#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "study/reader_json.hpp"
#include "study/stop_rule.hpp"
#include "study/study.hpp"

namespace steerstat {

/// Decodes a spec's `stop`. Its max_trials, where it has one, becomes the number of the sampling's trials: a study that
/// takes at most so many is the same in either writing.
///
/// @param sampling         the study's; its trials are changed
/// @param trials_are_given  whether the spec says how many trials the sampling has
/// @param measured         whether the study measures optional metrics; a goal on one that it leaves out is a mistake
/// @return nothing where mistakes were noted
std::optional<StopRule> decode_stop(const Reader& reader, Sampling& sampling, bool trials_are_given, bool measured);

/// The rule as a spec writes it.
nlohmann::json encode_stop(const StopRule& rule);

}  // namespace steerstat
