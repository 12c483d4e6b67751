#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "study/trial_range.hpp"

namespace steerstat {

/// Hands out a study's blocks in order, so that what is finished is always all trials up to some index, and of those
/// after it the ones that were finished before the run. Thread-safe.
class BlockQueue {
 public:
  /// @param known  trials finished before the run, ascending
  BlockQueue(std::span<const TrialRange> known, std::uint64_t trials, std::uint64_t block, std::stop_token stop)
      : trials_(trials), blocks_(missing_blocks(known, trials, block)), stop_(std::move(stop)) {}

  /// Every block that is to run.
  [[nodiscard]] std::span<const TrialRange> blocks() const { return blocks_; }

  /// The next block; nothing once all are taken, a stop was requested or halt() was called.
  std::optional<TrialRange> claim() {
    if (halted_.load(std::memory_order_relaxed) || stop_.stop_requested()) return std::nullopt;
    const std::uint64_t next = next_.fetch_add(1, std::memory_order_relaxed);
    if (next >= blocks_.size()) return std::nullopt;
    return blocks_[next];
  }

  /// Ends the run: no further block is begun.
  void halt() { halted_.store(true, std::memory_order_relaxed); }

  /// The first trial in a block that was not begun; the number of trials where all were.
  [[nodiscard]] std::uint64_t first_left() const {
    const std::uint64_t next = next_.load(std::memory_order_relaxed);
    return next < blocks_.size() ? blocks_[next].begin : trials_;
  }

  /// Trials in the blocks begun.
  [[nodiscard]] std::uint64_t begun() const {
    const std::uint64_t next = std::min<std::uint64_t>(next_.load(std::memory_order_relaxed), blocks_.size());
    return trials_in(std::span(blocks_).first(next));
  }

 private:
  const std::uint64_t trials_;
  const std::vector<TrialRange> blocks_;
  const std::stop_token stop_;
  std::atomic<std::uint64_t> next_{0};
  std::atomic<bool> halted_{false};
};

}  // namespace steerstat
