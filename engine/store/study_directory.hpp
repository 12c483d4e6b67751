#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "store/directory_lock.hpp"
#include "store/result_file.hpp"
#include "store/shard.hpp"
#include "study/outcome_sink.hpp"
#include "study/run.hpp"

namespace steerstat {

/// A file that could not be used and was given another name, so that nothing is lost and nobody trips over it again.
struct SetAside {
  std::filesystem::path file;  ///< its new name
  std::string reason;
};

/// What an earlier run of a study left.
struct Recovery {
  FinishedTrials finished;
  std::vector<SetAside> set_aside;  ///< the trials in them are to run again
};

/// A directory that keeps a study while it runs: the study itself and shards of its finished trials, immutable files
/// that are written whole or not at all, so that a kill, a power cut or a full disk at any moment costs nothing that
/// was kept. One process at a time has it. Not thread-safe.
class StudyDirectory {
 public:
  /// Takes the directory, making it where there is none, and deletes what an earlier process was writing when it died.
  /// @throws RunFailure, where another process has it too
  explicit StudyDirectory(std::filesystem::path path);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// Whether there is any shard, whatever its state.
  [[nodiscard]] bool has_shards() const;

  /// The study that was begun here; nothing where none was. @throws RunFailure where its file cannot be read
  [[nodiscard]] std::optional<StoredStudy> begun() const;

  /// Sets aside the file of the study that was begun here. @throws RunFailure
  SetAside set_study_aside(const std::string& reason);

  /// Writes the study, in place of another where one was begun. Once this returns it is on the disk. @throws RunFailure
  /// @param share  where no more than that share of it runs here
  void begin(const Study& study, std::optional<StudyShare> share = {});

  /// Reads every shard, all of it, and sets aside those that are damaged, or of another study or engine version than
  /// the one begun. @throws RunFailure
  Recovery recover();

  /// Keeps finished trials of the study begun. Once this returns they are on the disk.
  /// @param wall_s  [s] that the run took for them
  /// @throws RunFailure
  void keep(std::uint64_t first, std::span<const TrialOutcome> outcomes, double wall_s);

  /// The same of a study that does not keep all rows. @param piece  with a sketch of at least one trial
  void keep(const FinishedTrials& piece);

  /// Writes the result of the study begun, and deletes the shards only once it is on the disk.
  /// @param path  of the result, in this directory or elsewhere on its file system
  /// @throws RunFailure; the shards are then still there, unless it is they that could not be deleted
  void consolidate(const std::filesystem::path& path, const StudyResult& result);

  /// Deletes what this class makes, and the directory unless there is something else in it. @throws RunFailure
  void remove();

 private:
  [[nodiscard]] bool holds(const Study& study, std::optional<StudyShare> share) const;
  [[nodiscard]] FinishedTrials read_part(const std::filesystem::path& file) const;
  SetAside set_aside(const std::filesystem::path& file, const std::string& reason) const;
  void remove_files(std::initializer_list<const char*> prefixes) const;

  std::filesystem::path path_;
  std::optional<DirectoryLock> lock_;
  std::optional<Study> study_;  // the one begun
  ShardOrigin origin_;          // of its shards
};

/// Keeps a run's finished trials in a study's directory while it goes on.
class ShardSink final : public OutcomeSink {
 public:
  /// @param directory  begun; must outlive this
  explicit ShardSink(StudyDirectory& directory) : directory_(directory) {}
  void take(std::uint64_t begin, std::span<const TrialOutcome> outcomes) override;
  void take_sketched(const FinishedTrials& piece) override;

 private:
  using Clock = std::chrono::steady_clock;
  StudyDirectory& directory_;
  Clock::time_point last_{Clock::now()};
};

}  // namespace steerstat
