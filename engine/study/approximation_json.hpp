#pragma once

#include <filesystem>
#include <string_view>
#include <variant>

#include "study/approximation.hpp"
#include "study/study.hpp"

namespace steerstat {

/// Decodes the spec of an approximation study (schemas/approximation.schema.json), filling in every default.
///
/// @throws BadSpec with every mistake at once
ApproximationStudy decode_approximation(std::string_view text);

/// Decodes a spec of either kind, as its "kind" says; without one it is a stabilisation study.
///
/// @param directory  as of decode_study()
/// @throws BadSpec
std::variant<Study, ApproximationStudy> decode_any_study(std::string_view text, const std::filesystem::path& directory);

}  // namespace steerstat
