#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <vector>

#include "study/precision_watch.hpp"

namespace steerstat {

/// Shows a watch the outcomes of a run's blocks, which finish in any order, in the order of their indices. Thread-safe.
///
/// Which trials it has shown depends on timing; where the watch stops does not, as it sees each trial after all those
/// before it.
class FinishedPrefix {
 public:
  /// @param outcomes  (trials) by index; one that is finished() must not be written any more
  FinishedPrefix(PrecisionWatch watch, const std::vector<TrialOutcome>& outcomes, std::uint64_t block)
      : watch_(std::move(watch)),
        outcomes_(outcomes),
        block_(block),
        unfinished_((outcomes.size() + block - 1) / block) {
    for (std::uint64_t i = 0; i < unfinished_.size(); ++i) unfinished_[i] = end_of(i) - i * block;
  }

  /// Notes that a trial's outcome is written. @return whether the watch has stopped
  bool finished(std::uint64_t index) {
    if (unfinished_[index / block_].fetch_sub(1, std::memory_order_acq_rel) == 1) show();
    return stopped_.load(std::memory_order_relaxed);
  }

 private:
  [[nodiscard]] std::uint64_t end_of(std::uint64_t block) const {
    return std::min<std::uint64_t>((block + 1) * block_, outcomes_.size());
  }

  [[nodiscard]] bool next_is_finished() const {
    const std::uint64_t next = next_.load();
    return next < unfinished_.size() && unfinished_[next].load() == 0;
  }

  void show() {
    // Whoever holds the mutex looks again after letting go, so that nobody else need wait for a look to end.
    while (next_is_finished()) {
      const std::unique_lock lock(mutex_, std::try_to_lock);
      if (!lock) return;
      while (next_is_finished()) {
        const std::uint64_t block = next_.load();
        for (std::uint64_t i = block * block_; i < end_of(block); ++i) watch_.add(outcomes_[i]);
        next_.store(block + 1);
      }
      if (watch_.stopped()) stopped_.store(true, std::memory_order_relaxed);
    }
  }

  PrecisionWatch watch_;
  const std::vector<TrialOutcome>& outcomes_;
  const std::uint64_t block_;
  std::vector<std::atomic<std::uint64_t>> unfinished_;  // trials of each block
  std::atomic<std::uint64_t> next_{0};                  // the first block that was not shown
  std::atomic<bool> stopped_{false};
  std::mutex mutex_{};
};

}  // namespace steerstat
