#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>

#include "study/trial_table.hpp"
#include "trial/trial.hpp"

namespace steerstat {

/// Takes the outcomes of a run while it goes on, to keep them whatever happens to the process.
///
/// It is called from one thread of the run's own, which holds up no trial, at most once per trial, in rising order of
/// index: as soon as 2^16 trials wait, or a twentieth of the time since the run began has passed since the last call,
/// but at least a tenth of a second and at most ten.
class OutcomeSink {
 public:
  OutcomeSink() = default;
  virtual ~OutcomeSink() = default;
  OutcomeSink(const OutcomeSink&) = delete;
  OutcomeSink& operator=(const OutcomeSink&) = delete;

  /// Shows where the outcomes of all trials lie, before the first is taken: those finished earlier are there, any other
  /// may be looked at once it was taken. Called again, after close(), with the trials of a run that is complete, while
  /// it is audited.
  ///
  /// @param slots  (trials) by index; there until close()
  virtual void open(std::span<const TrialOutcome> /*slots*/) {}

  /// Nothing shown by open() may be looked at any more. Called at the end of a run, also one that fails.
  virtual void close() noexcept {}

  /// Takes finished trials. What it throws ends the run and leaves run_study().
  ///
  /// @param begin     index of the first
  /// @param outcomes  (trials) of consecutive indices, at least one
  virtual void take(std::uint64_t begin, std::span<const TrialOutcome> outcomes) = 0;

  /// Takes finished trials of a study that does not keep all rows, instead: a sketch of them and the rows that are
  /// kept. Each trial once, in rising order of index. What it throws ends the run, likewise. A sink that takes rows
  /// alone need not have it.
  virtual void take_sketched(const FinishedTrials& /*piece*/) {
    throw std::logic_error("this sink takes the rows of all trials");
  }
};

}  // namespace steerstat
