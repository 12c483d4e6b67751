#pragma once

#include <filesystem>
#include <optional>

#include "study/reader_json.hpp"
#include "study/study.hpp"

namespace steerstat {

/// Decodes a spec's `sampling`.
///
/// @param directory  where a file of explicit trials is looked up; empty: such a file is refused
/// @return with defaults where mistakes were noted
Sampling decode_sampling(const Reader& reader, const std::filesystem::path& directory);

/// Sampling as a spec writes it, explicit trials inlined.
nlohmann::json encode_sampling(const Sampling& sampling);

}  // namespace steerstat
