#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "report/comparison.hpp"
#include "service/launcher.hpp"
#include "service/service_counters.hpp"
#include "service/service_errors.hpp"
#include "service/service_limits.hpp"
#include "service/study_rows.hpp"
#include "service/study_state.hpp"
#include "study/study.hpp"

namespace steerstat {

/// What became of a spec that was sent.
struct Submission {
  StudyState state;
  bool created;  ///< false where the very study was there; a cancelled or failed one of these goes on
};

/// Some of the studies, newest first.
struct StudyPage {
  std::vector<StudyState> studies;
  std::optional<std::string> next;  ///< where the next page begins; nothing at the end
};

/// A study's statistics as JSON (schemas/summary.schema.json).
struct SummaryText {
  std::string json;
  bool complete{false};  ///< of the whole study: it stays as it is
  /// The study's revision when it was made: while the study runs, a summary may be older than its state.
  std::uint64_t revision{0};
};

/// Runs studies and answers for them: a catalogue on the disk, a queue, and readers. It knows no HTTP. Thread-safe: all
/// but construction and destruction may be called from any threads at once.
///
/// A study is known by study_id(): the same spec is the same study. It lives in DATA/studies/ID (schemas/
/// study_directory.md), and those directories are the only catalogue, so that there is no second truth for them to
/// disagree with: an index of them is made in memory at the start. Unfinished studies go on then by themselves, from
/// the trials that were finished, to the same bits as without the interruption.
class StudyService {
 public:
  /// Takes the data directory, making it where there is none, and begins to run what is unfinished.
  ///
  /// @param threads  0: one a core
  /// @param tell     gets what an administrator should know, a line each, from any thread, one at a time; may be empty
  /// @param launcher  runs each study as a program of its own, elsewhere; nothing: they run in this process
  /// @throws RunFailure naming the directory, where another process has it too or it cannot be used
  StudyService(const std::filesystem::path& data, unsigned threads, const ServiceLimits& limits = {},
               std::function<void(const std::string&)> tell = {}, std::optional<Launcher> launcher = {});

  /// As stop().
  ~StudyService();
  StudyService(const StudyService&) = delete;
  StudyService& operator=(const StudyService&) = delete;

  /// Ends the runs once the blocks in flight are finished and kept, and waits for that, but for stopping_time at most:
  /// then those are given up. They go on at the next start.
  /// submit() and cancel_or_remove() are refused from then on, readers are not. Wakes all who wait_for_change().
  /// Idempotent.
  void stop();

  /// Takes a spec. Once it returns, the study is on the disk and will be run whatever happens to the process. Where a
  /// stored study is one that this one continues(), its finished trials are this one's too, and not run again.
  ///
  /// Of the kinds of studies, stabilisation alone: an approximation study keeps no trials, has nothing to resume, and
  /// is answered by `steerstat run` in seconds. A spec that names files is refused: there are none of the client's
  /// here.
  ///
  /// @throws BadSpec with every mistake, LimitExceeded, QueueFull, RunFailure where it cannot be kept
  Submission submit(std::string_view spec);

  /// @param limit   at most so many, > 0
  /// @param cursor  `next` of the page before; empty for the first
  /// @throws BadUsage for a cursor that is none
  [[nodiscard]] StudyPage list(std::size_t limit, std::string_view cursor = {}) const;

  /// @return nothing where there is no such study
  [[nodiscard]] std::optional<StudyState> state(const std::string& id) const;

  /// The state as soon as its revision is another than this one; at the latest after the timeout, on a stop request and
  /// on stop(), with the revision it then has.
  /// @return nothing where there is no such study, or no longer
  [[nodiscard]] std::optional<StudyState> wait_for_change(const std::string& id, std::uint64_t revision,
                                                          std::chrono::milliseconds timeout,
                                                          const std::stop_token& stop = {}) const;

  // All that follow throw NoSuchStudy where there is none of that id, and RunFailure where its files cannot be read.

  /// The summary: of all trials where the study has succeeded, else of those finished from the first on without a gap.
  /// While the study runs it is made anew a few times a second at most, however often it is asked for.
  [[nodiscard]] SummaryText summary(const std::string& id) const;

  /// The canonical spec: every default filled in.
  [[nodiscard]] std::string spec(const std::string& id) const;
  [[nodiscard]] std::shared_ptr<const Study> study(const std::string& id) const;

  /// Finished trials from index `begin` on. While the study runs, those up to the first gap.
  /// @param limit  at most so many, > 0
  [[nodiscard]] TrialPage trials(const std::string& id, const TrialFilter& filter, std::uint64_t begin,
                                 std::size_t limit) const;

  /// One finished trial, as a page of one. @throws NoSuchTrial
  [[nodiscard]] TrialPage trial(const std::string& id, std::uint64_t index) const;

  /// Computes a finished trial again. @throws NoSuchTrial; TakesTooLong; RunFailure where it does not end as it did
  [[nodiscard]] ReplayedTrial trajectory(const std::string& id, std::uint64_t index) const;

  /// The result file (schemas/result_file.md), which may be read as long as it is open, also when it is removed. Of a
  /// cancelled or failed study it has the finished trials. While a study is unfinished there is none: every reader of a
  /// snapshot would make the disk write all the trials again, and the summary and the trials tell what is known.
  /// @return nothing where there is none
  [[nodiscard]] std::optional<std::filesystem::path> result_file(const std::string& id) const;

  /// Cancels a study that waits or runs: no further block is begun, the finished trials are kept, and it goes on when
  /// it is submitted again. Removes one that is over, with all its files. Holds nobody up who does not ask for the very
  /// study.
  /// @return its state: cancelled, or succeeded where it was about to end anyway. The blocks in flight are finished, or
  ///         given up after ending_time. Where even that takes longer than cancelling_time it is still running, and is
  ///         cancelled in the end, also when the process ends before. Of a study removed, the last state
  struct Removal {
    StudyState state;
    bool removed{false};
  };
  Removal cancel_or_remove(const std::string& id);

  /// Compares the finished trials of two studies, those of B with those of A. @throws StudiesDoNotPair too
  [[nodiscard]] Comparison compare(const std::string& a, const std::string& b) const;

  // What a page draws of them: documents of schemas/view.schema.json.

  /// A study, without maps. Kept while it is asked for; of a running one it is made anew now and then.
  [[nodiscard]] std::shared_ptr<const std::string> study_view(const std::string& id) const;

  /// @throws NoSuchAxis and BadUsage as success_map() does, and BadUsage for a study that seeks failures
  [[nodiscard]] std::string success_map(const std::string& id, std::string_view x, std::string_view y) const;

  /// Computes a finished trial again. @throws as trajectory()
  [[nodiscard]] std::string trial_view(const std::string& id, std::uint64_t index) const;

  /// @throws as compare()
  [[nodiscard]] std::string comparison_view(const std::string& a, const std::string& b) const;

  [[nodiscard]] ServiceCounters counters() const;
  [[nodiscard]] const ServiceLimits& limits() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace steerstat
