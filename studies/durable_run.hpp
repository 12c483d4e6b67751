#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "distributed/lead.hpp"
#include "distributed/ranks.hpp"
#include "store/study_directory.hpp"
#include "study/run.hpp"
#include "study/study.hpp"

namespace steerstat {

/// A run into a result file whose finished trials outlive the process. Until the result is in place they are in a
/// directory beside it, RESULT.parts. A result that goes to a device or a pipe has none.
class DurableRun {
 public:
  /// Takes the directory, and reads what an earlier run has left where it is to be resumed. Tells the user of it.
  ///
  /// @param share   where only that share of the study is to run
  /// @param resume  whether to go on with an interrupted run, its directory or its incomplete result; begins anew where
  ///                there is neither
  /// @throws BadUsage where there is another study's, or finished trials that nobody asked to resume; RunFailure
  DurableRun(const std::filesystem::path& result, const Study& study, std::optional<StudyShare> share, bool resume);

  /// Runs what is not finished yet. @throws as run_study() and run_range() do; a RunFailure says what is kept
  ///
  /// @param ranks    those that run it together, this one leading; null: this process alone
  /// @param sharing  see run_on_ranks()
  StudyResult run(RunOptions options, Ranks* ranks = nullptr, const Sharing& sharing = {});

  /// Writes the result, then removes the directory. @throws RunFailure saying what is kept
  void keep(const StudyResult& result);

 private:
  void begin_anew();
  void resume();
  std::optional<StoredStudy> earlier_result(bool interrupted) const;
  FinishedTrials recover();
  void require_continuation(const StoredStudy& stored, const std::filesystem::path& place) const;
  [[nodiscard]] std::string objection(const StoredStudy& stored, const std::filesystem::path& place) const;
  [[nodiscard]] bool has_nothing_left(const StoredStudy& stored) const;
  [[nodiscard]] StudyResult run_now(const RunOptions& options);
  [[nodiscard]] StudyResult run_together(const RunOptions& options, Ranks& ranks, const Sharing& sharing);

  std::filesystem::path path_;
  std::filesystem::path parts_;
  const Study& study_;
  std::optional<StudyShare> share_;  // of the study
  std::uint64_t due_;                // trials to run in all
  std::optional<StudyDirectory> directory_;
  FinishedTrials finished_;           // by earlier runs
  std::optional<StudyResult> whole_;  // where there is nothing left to run
};

}  // namespace steerstat
