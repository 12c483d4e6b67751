#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <span>
#include <stop_token>
#include <thread>
#include <vector>

#include "study/outcome_sink.hpp"
#include "study/trial_range.hpp"

namespace steerstat {

/// Hands the outcomes of finished blocks to a sink, from a thread of its own, while workers go on. Blocks finish in
/// any order; the sink gets each after those before it.
class HandOver {
 public:
  /// @param blocks      those to run, as missing_blocks() gives them; must outlive this
  /// @param block       trials in a whole block
  /// @param outcomes    (trials) by index; one that is finished() must not be written any more
  /// @param on_failure  called, from the thread, when the sink has thrown
  HandOver(OutcomeSink& sink, std::span<const TrialRange> blocks, std::uint64_t block,
           std::span<const TrialOutcome> outcomes, std::function<void()> on_failure);
  ~HandOver() = default;
  HandOver(const HandOver&) = delete;
  HandOver& operator=(const HandOver&) = delete;

  /// Notes that a trial's outcome is written. Thread-safe.
  void finished(std::uint64_t index) { unfinished_[index / block_].fetch_sub(1, std::memory_order_release); }

  /// Ends the thread, after which the sink gets what is finished and still waits. @throws what the sink throws
  void finish();

 private:
  using Clock = std::chrono::steady_clock;

  void work_until(const std::stop_token& stop);
  void find_finished();
  [[nodiscard]] bool due() const;
  void deliver(const std::stop_token& stop);

  OutcomeSink& sink_;
  const std::span<const TrialRange> blocks_;
  const std::uint64_t block_;
  const std::span<const TrialOutcome> outcomes_;
  const std::function<void()> on_failure_;
  std::vector<std::atomic<std::uint64_t>> unfinished_;  // trials of each block of the study, those to run alone
  const Clock::time_point start_{Clock::now()};
  Clock::time_point last_{start_};  // when the sink last took something
  std::size_t delivered_{0};        // blocks_ before it have gone to the sink
  std::size_t found_{0};            // blocks_ before it are finished
  std::uint64_t waiting_{0};        // trials in between
  std::exception_ptr failure_{};
  std::jthread thread_{};  // last: it uses all of the above
};

}  // namespace steerstat
