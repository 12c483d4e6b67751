#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "service/study_record.hpp"
#include "store/result_file.hpp"
#include "store/shard.hpp"
#include "store/study_directory.hpp"
#include "study/run.hpp"
#include "study/study.hpp"

namespace steerstat {

/// Finished trials of a study, read from the disk.
struct KeptStudy {
  StudyResult result;
  std::string engine_version;  ///< that computed them
};

/// The directory of one study of the service (schemas/study_directory.md): its files and what they say. Reading it is
/// thread-safe, also while its study runs.
class StudyHome {
 public:
  /// @param path  .../studies/ID, there or not
  explicit StudyHome(std::filesystem::path path) : path_(std::move(path)) {}

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path record() const { return path_ / "state.json"; }
  [[nodiscard]] std::filesystem::path result() const { return path_ / "results.h5"; }
  /// The finished trials of a study that was cancelled or failed, for who asks for them; may be deleted at any time.
  [[nodiscard]] std::filesystem::path partial_result() const { return path_ / "partial.h5"; }
  [[nodiscard]] std::filesystem::path summary() const { return path_ / "summary.json"; }
  /// Of a study that is run through a launcher: what it is to run, where it writes, what it says and which it is.
  [[nodiscard]] std::filesystem::path launched_spec() const { return path_ / "launched.json"; }
  [[nodiscard]] std::filesystem::path launched_result() const { return path_ / "launched.h5"; }
  [[nodiscard]] std::filesystem::path launched_parts() const { return path_ / "launched.h5.parts"; }
  [[nodiscard]] std::filesystem::path launched_log() const { return path_ / "launched.log"; }
  [[nodiscard]] std::filesystem::path launched_note() const { return path_ / "launched.process"; }

  /// Makes the directory. On return it is on the disk; where it throws, nothing is left that passes for a study.
  ///
  /// @param earlier  of a study that this one continues(), whose finished trials it is to have too; or null
  /// @throws RunFailure
  void create(const Study& study, const StudyRecord& record, const StudyHome* earlier) const;

  /// Whether a study was ever acknowledged here.
  [[nodiscard]] bool holds_study() const;

  /// The study, without trials. @throws RunFailure where neither its file nor its result can be read
  [[nodiscard]] StoredStudy study() const;

  /// How many trials the names of its shards tell of. @throws RunFailure
  [[nodiscard]] std::uint64_t trials_in_shards() const;

  /// The same of the shards of what is run through a launcher, as long as there are any.
  [[nodiscard]] std::uint64_t launched_trials() const;

  /// Every finished trial there is, read without changing anything; what is damaged is passed over.
  /// @param origin      of its shards
  /// @param parameters  where there is a result gets its (varying x rows), and else stays as it is; or null
  [[nodiscard]] KeptStudy read(const Study& study, const ShardOrigin& origin,
                               std::vector<std::vector<double>>* parameters = nullptr) const;

  /// The trials that a run of the study need not run again, those of links to earlier studies' too. Sets aside what is
  /// damaged. @param directory  of this path, the study begun @param tell  gets what was set aside @throws RunFailure
  [[nodiscard]] FinishedTrials recover(StudyDirectory& directory, const Study& study,
                                       const std::function<void(const std::string&)>& tell) const;

  /// The result, where it is there and whole. @throws RunFailure where it cannot be read
  [[nodiscard]] std::optional<StudyResult> whole_result(const Study& study) const;

  /// Puts the trials that are finished here, or were in a study that this one extends, where what is run through a
  /// launcher goes on from them. Repeated, after a kill at any moment, it does what is left.
  /// @param directory, tell  as for recover() @throws RunFailure
  void hand_to_launched(StudyDirectory& directory, const Study& study,
                        const std::function<void(const std::string&)>& tell) const;

  /// Deletes what a result has made superfluous: links to earlier studies, a partial result. @throws RunFailure
  void forget_earlier() const;
  void forget_partial_result() const;
  void forget_launched() const;

  /// Deletes files that a process was writing when it died. @throws RunFailure
  void clear_temporaries() const;

  /// Removes the directory: at once as a study, then its files. @throws RunFailure where it is still there
  void remove() const;

  /// Renames the directory, so that nothing is lost and nobody trips over it again.
  /// @return its new path @throws RunFailure
  [[nodiscard]] std::filesystem::path set_aside() const;

  /// Names of directories beside studies, by their beginnings.
  static constexpr const char* removed_prefix = ".removed-";
  static constexpr const char* damaged_prefix = "damaged-";

 private:
  [[nodiscard]] std::vector<std::filesystem::path> launched_shards() const;
  [[nodiscard]] FinishedTrials launched_finished(const Study& study, const ShardOrigin& origin) const;
  void link_from(const StudyHome& earlier) const;

  std::filesystem::path path_;
};

}  // namespace steerstat
