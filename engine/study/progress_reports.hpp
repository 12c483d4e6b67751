#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <numeric>
#include <stop_token>
#include <thread>
#include <vector>

#include "core/elapsed.hpp"
#include "study/block_queue.hpp"
#include "study/run.hpp"

namespace steerstat {

/// One worker's count of finished trials, on a cache line of its own so that counting costs the other workers nothing.
struct alignas(64) Tally {
  std::atomic<std::uint64_t> finished{0};
};

/// How many trials all workers have finished.
inline std::uint64_t finished_of(const std::vector<Tally>& tallies) {
  return std::accumulate(tallies.begin(), tallies.end(), std::uint64_t{0}, [](std::uint64_t sum, const Tally& tally) {
    return sum + tally.finished.load(std::memory_order_relaxed);
  });
}

/// Calls the progress callback from a thread of its own, which sleeps in between, until destroyed or finish()ed.
class ProgressReports {
 public:
  /// @param earlier  trials finished before the run
  ProgressReports(const RunOptions& options, std::uint64_t requested, std::uint64_t earlier,
                  const std::vector<Tally>& tallies, std::chrono::steady_clock::time_point start, BlockQueue& blocks)
      : callback_(options.on_progress),
        requested_(requested),
        earlier_(earlier),
        tallies_(tallies),
        start_(start),
        blocks_(blocks) {
    if (callback_) thread_ = std::jthread([this](const std::stop_token& stop) { report_until(stop); });
  }

  /// Makes the last report, from the calling thread. @throws what the callback threw
  void finish() {
    if (!callback_) return;
    thread_.request_stop();
    thread_.join();
    if (failure_) std::rethrow_exception(failure_);
    report();
  }

 private:
  void report() { callback_(Progress{earlier_ + finished_of(tallies_), requested_, seconds_since(start_), earlier_}); }

  void report_until(const std::stop_token& stop) {
    constexpr std::chrono::milliseconds interval{200};
    std::mutex mutex;
    std::condition_variable_any wake;
    std::unique_lock lock(mutex);
    try {
      while (!stop.stop_requested()) {
        report();
        wake.wait_for(lock, stop, interval, [] { return false; });
      }
    } catch (...) {
      failure_ = std::current_exception();
      blocks_.halt();
    }
  }

  const std::function<void(const Progress&)>& callback_;
  const std::uint64_t requested_;
  const std::uint64_t earlier_;
  const std::vector<Tally>& tallies_;
  const std::chrono::steady_clock::time_point start_;
  BlockQueue& blocks_;
  std::exception_ptr failure_{};
  std::jthread thread_{};  // last: it uses all of the above
};

}  // namespace steerstat
