#pragma once

#include <filesystem>

namespace steerstat {

// What lies in a study's directory (schemas/study_directory.md), for those who keep it and those who look into it.
inline constexpr const char* study_file = "study.h5";
inline constexpr const char* shard_prefix = "trials-";
inline constexpr const char* temporary_prefix = ".tmp-";

/// Deletes a file; one that is gone already is no failure. @throws RunFailure naming it
void remove_file(const std::filesystem::path& path);

}  // namespace steerstat
