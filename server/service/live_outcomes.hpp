#pragma once

#include <algorithm>
#include <cstdint>
#include <shared_mutex>
#include <span>
#include <utility>
#include <vector>

#include "study/outcome_sink.hpp"
#include "study/trial_range.hpp"
#include "trial/trial.hpp"

namespace steerstat {

/// Lets readers see the trials of a run while it goes on, in the run's own memory: those from the first on up to the
/// first gap, which do not change any more. Readers hold up no trial; what they hold up is the thread that keeps trials
/// and the end of the run. Thread-safe.
class LiveOutcomes final : public OutcomeSink {
 public:
  /// @param keeper  takes the trials first: nobody sees what is not kept
  /// @param known   trials finished before the run, ascending
  LiveOutcomes(OutcomeSink& keeper, std::vector<TrialRange> known)
      : keeper_(keeper), known_(std::move(known)), kept_(trials_in(known_)) {}

  void open(std::span<const TrialOutcome> slots) override;
  void close() noexcept override;
  void take(std::uint64_t begin, std::span<const TrialOutcome> outcomes) override;

  /// Trials that are on the disk.
  [[nodiscard]] std::uint64_t kept() const {
    const std::shared_lock lock(mutex_);
    return kept_;
  }

  /// Calls look(outcomes) with the outcomes of trials 0, 1, ... up to the first gap, valid during the call.
  /// @return false where there is nothing to see, before the run's first trial and after its last
  template <class Look>
  bool read(const Look& look) const {
    const std::shared_lock lock(mutex_);
    if (!is_open_) return false;
    look(slots_.first(std::min<std::size_t>(prefix_, slots_.size())));
    return true;
  }

 private:
  void extend();

  OutcomeSink& keeper_;
  const std::vector<TrialRange> known_;
  mutable std::shared_mutex mutex_{};
  bool is_open_{false};
  std::span<const TrialOutcome> slots_{};
  std::uint64_t prefix_{0};
  std::uint64_t kept_;
  std::size_t next_known_{0};  // the first range of known_ that is beyond the prefix
};

}  // namespace steerstat
