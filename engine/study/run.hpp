#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>
#include <vector>

#include "study/plan.hpp"
#include "study/study.hpp"
#include "trial/replay.hpp"

namespace steerstat {

/// How far a run has come.
struct Progress {
  std::uint64_t completed{0};  ///< trials finished
  std::uint64_t requested{0};
  double elapsed{0.0};  ///< [s] wall time since the run began
};

struct RunOptions {
  unsigned threads{0};  ///< 0: one a core
  /// Called from one thread at a time, a few times a second; may be empty.
  std::function<void(const Progress&)> on_progress{};
  std::stop_token stop{};  ///< a request ends the run after the blocks in flight
};

/// Finished trials, as columns in index order. Whole blocks only: a run that was stopped keeps every block it had
/// begun, so which trials are kept never depends on how they ended.
struct TrialTable {
  std::vector<std::uint64_t> index;    ///< (rows) ascending
  std::vector<TrialOutcome> outcomes;  ///< (rows)
};

/// What a run leaves.
struct StudyResult {
  TrialTable trials;
  bool complete{false};
  struct Retained {
    std::uint64_t index;
    Trajectory trajectory;
  };
  std::vector<Retained> trajectories;  ///< as `retention` asks, by index
  double wall_s{0.0};
  unsigned threads{0};
};

/// Runs a study on TBB. The outcomes are the same bits whatever the number of threads.
///
/// @throws RunFailure (and whatever a worker throws: a bug) with nothing kept.
StudyResult run_study(const Study& study, const RunOptions& options);

}  // namespace steerstat
