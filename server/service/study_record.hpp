#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "service/study_state.hpp"

namespace steerstat {

/// What a study's directory says beside its spec and its trials: `state.json` (schemas/study_directory.md).
struct StudyRecord {
  StudyStatus status{StudyStatus::queued};  ///< queued stands for running too: which is no property of the disk
  std::uint64_t completed{0};               ///< trials, when it was written
  std::string created;
  std::optional<std::string> started;
  std::optional<std::string> finished;
  std::optional<std::string> failure;
  std::optional<std::string> summary_seal;  ///< seal_of() the summary kept beside it
  std::uint64_t revision{0};
};

/// Writes it, whole or not at all; on return it is on the disk, of which it may use the reserve: a full disk is what it
/// may have to tell of. @throws RunFailure
void write_record(const std::filesystem::path& path, const StudyRecord& record);

/// @throws RunFailure where it is missing or not what write_record() writes
StudyRecord read_record(const std::filesystem::path& path);

/// The time, UTC: "2025-01-31T12:00:00.123Z".
std::string utc_now();

/// A revision that follows `before`: microseconds since 1970, or one more than before.
std::uint64_t next_revision(std::uint64_t before);

}  // namespace steerstat
