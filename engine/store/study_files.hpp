#pragma once

#include <filesystem>
#include <initializer_list>
#include <system_error>
#include <vector>

namespace steerstat {

// What lies in a study's directory (schemas/study_directory.md), for those who keep it and those who look into it.
inline constexpr const char* study_file = "study.h5";
inline constexpr const char* shard_prefix = "trials-";
inline constexpr const char* temporary_prefix = ".tmp-";

/// @throws RunFailure "cannot VERB PATH (what the system says)"
[[noreturn]] void fail_at(const char* verb, const std::filesystem::path& path, const std::error_code& error);

/// The files of a directory whose names begin with one of `prefixes`, sorted. @throws RunFailure naming the directory
std::vector<std::filesystem::path> files_in(const std::filesystem::path& directory,
                                            std::initializer_list<const char*> prefixes);

/// Deletes a file; one that is gone already is no failure. @throws RunFailure naming it
void remove_file(const std::filesystem::path& path);

}  // namespace steerstat
