#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "study/run.hpp"
#include "study/study.hpp"

namespace steerstat {

/// A result file read back.
struct StoredStudy {
  Study study;
  std::string created;                          ///< UTC, ISO 8601
  std::string engine_version;                   ///< of the program that wrote it
  StudyResult result;                           ///< trajectories are not read back
  bool has_metrics{true};                       ///< not in files of programs that measured none
  std::vector<std::vector<double>> parameters;  ///< (varying x rows), in the order of Plan::varying()
};

/// Checks, before the first trial runs, that a result could be written at `path`.
/// @throws RunFailure naming the path and the reason
void require_writable(const std::filesystem::path& path);

/// Writes a result file (schemas/result_file.md): under a temporary name beside `path`, closed, fsynced, renamed, and
/// the directory fsynced, so that nobody ever reads half a file.
/// @param workshop  where the temporary file stands instead, see write_whole_file()
/// @throws RunFailure; whatever stood at `path` is then untouched
void write_result(const std::filesystem::path& path, const Study& study, const StudyResult& result,
                  const std::filesystem::path& workshop = {});

/// Reads a result file and checks it.
/// @throws RunFailure for a file that is missing, damaged or not ours
StoredStudy read_result(const std::filesystem::path& path);

}  // namespace steerstat
