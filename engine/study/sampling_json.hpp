#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "study/reader_json.hpp"
#include "study/study.hpp"

namespace steerstat {

/// Decodes a spec's `sampling`.
///
/// @param directory  where a file of explicit trials is looked up; empty: such a file is refused
/// @param inputs     decoded: only those with distributions can be correlated
/// @param mistaken   names of the inputs that have mistakes of their own
/// @return with defaults where mistakes were noted
Sampling decode_sampling(const Reader& reader, const std::filesystem::path& directory, std::span<const Input> inputs,
                         std::span<const std::string> mistaken);

/// Sampling as a spec writes it, explicit trials inlined.
nlohmann::json encode_sampling(const Sampling& sampling);

}  // namespace steerstat
