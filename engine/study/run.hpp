#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "core/instruction_set.hpp"
#include "study/audit.hpp"
#include "study/check_in.hpp"
#include "study/outcome_sink.hpp"
#include "study/plan.hpp"
#include "study/share.hpp"
#include "study/study.hpp"
#include "study/trial_table.hpp"
#include "study/turnstile.hpp"
#include "trial/replay.hpp"
#include "trial/runner.hpp"

namespace steerstat {

/// How far a run has come.
struct Progress {
  std::uint64_t completed{0};  ///< trials finished
  std::uint64_t requested{0};
  double elapsed{0.0};       ///< [s] wall time since the run began
  std::uint64_t earlier{0};  ///< of the completed, trials finished before the run began
};

struct RunOptions {
  unsigned threads{0};  ///< 0: one a core
  /// Called from one thread at a time: before the first trial, a few times a second, and after the last; may be empty.
  /// What it throws ends the run and leaves run_study().
  std::function<void(const Progress&)> on_progress{};
  std::stop_token stop{};                       ///< a request ends the run after the blocks in flight
  std::stop_token give_up{};                    ///< and this one gives them up: the run throws RunGivenUp
  InstructionSet simd{best_instruction_set()};  ///< what lockstep runs on; the outcomes are the same bits on each
  OutcomeSink* sink{nullptr};  ///< takes every finished trial of the run while it goes on; null: nobody does
  /// What the workers of several runs share the processors through, at every block, every trial of the audit and of the
  /// retained, and every few milliseconds of trials that take long; null: nobody is waited for. Whoever sets it says
  /// with SharedWorkers how many there may be.
  Turnstile* turns{nullptr};
  /// Makes each worker's runner, on that worker; empty: make_runner(integrator, simd).
  std::function<std::unique_ptr<TrialRunner>(const IntegratorChoice&)> make_runner{};
};

/// What a run leaves. Of the trials, whole blocks only, and those finished earlier: a run that was interrupted keeps
/// every block it had begun, so which trials are kept never depends on how they ended. A study that stopped on
/// precision keeps exactly the trials up to the look that stopped it.
struct StudyResult {
  TrialTable trials;     ///< as the study stores
  bool complete{false};  ///< every trial is there, or every one up to where the study's rule stopped it
  struct Retained {
    std::uint64_t index;
    Trajectory trajectory;
  };
  std::vector<Retained> trajectories;  ///< as `retention` asks, by index
  Audit audit;                         ///< as `audited_trials` asks; a stop cuts it short
  double wall_s{0.0};   ///< [s] the trials took, those finished earlier too, retained trajectories and audit not
  unsigned threads{0};  ///< workers that shared the trials: as asked, but never more than the study has blocks
  std::optional<InstructionSet> simd;  ///< what lockstep ran on; nothing with another integrator
  std::optional<StudyShare> share;     ///< where these are a share of the study; it is never complete then
  std::optional<TrialSketch> sketch;   ///< of all finished trials, where the study does not keep all of their rows

  /// How many trials have finished, whether their rows are kept or not.
  [[nodiscard]] std::uint64_t finished() const { return sketch ? sketch->count() : trials.index.size(); }
};

/// Trials a worker claims at a time: several times what the lanes of lockstep hold, which refill across blocks; few
/// with CVODE, whose trials take milliseconds, so that a stop is quick and the last blocks end together. Depends on the
/// study alone, so that what a stopped run keeps can be compared between machines.
std::uint64_t block_size(const Study& study);

/// What the trials of a study are dealt out in, to machines and processes: whole blocks, and whole draws where the
/// study does not keep all rows.
std::uint64_t portion_size(const Study& study);

/// One a core that this process may use.
unsigned default_threads();

/// While it lives, runs that share turns may have so many workers together; without it, as many as there are cores.
/// One in a process at a time.
class SharedWorkers {
 public:
  explicit SharedWorkers(unsigned workers);
  ~SharedWorkers();
  SharedWorkers(const SharedWorkers&) = delete;
  SharedWorkers& operator=(const SharedWorkers&) = delete;

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

/// Runs a study on TBB, then audits it. The outcomes and the audit are the same bits whatever the number of threads.
/// Safe to call from several threads at once.
///
/// @param earlier  trials of this study, or of one that it continues(), that need not run again; the result has them
///                 too, and is the same as if all had run now
/// @throws RunFailure, RunGivenUp, BadUsage where this machine does not run the instruction set asked for, and whatever
/// a worker, the progress callback or the sink throws, with nothing kept but by the sink.
StudyResult run_study(const Study& study, const RunOptions& options, FinishedTrials earlier = {});

/// Runs consecutive trials of a study, whatever its rule says, and audits none: of a study that runs in several places.
/// What it takes grows with the range and not with the study. Otherwise as run_study(); the sink is shown no slots.
///
/// @param range    begins where a block begins (block_size()), or a draw where the study does not keep all rows
/// @param earlier  those outside of the range are dropped
/// @return not complete; the range has finished where every trial of it is there
/// @throws std::invalid_argument for another range
StudyResult run_range(const Study& study, TrialRange range, const RunOptions& options, FinishedTrials earlier = {});

}  // namespace steerstat
