#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "service/catalogue.hpp"
#include "service/launcher.hpp"
#include "service/service_limits.hpp"
#include "study/run.hpp"
#include "study/turnstile.hpp"

namespace steerstat {

/// Runs the studies that wait, several at once: each with all workers, which share the processors by blocks at a
/// turnstile. Thread-safe. Nothing that a study throws leaves it: such a study has failed.
class StudyRunner {
 public:
  using Tell = std::function<void(const std::string&)>;

  /// @param catalogue  must outlive this
  /// @param threads    workers that may work at once, > 0
  /// @param launcher   runs the studies elsewhere; nothing: they run in this process
  StudyRunner(Catalogue& catalogue, unsigned threads, const ServiceLimits& limits, Tell tell,
              std::optional<Launcher> launcher);
  ~StudyRunner();
  StudyRunner(const StudyRunner&) = delete;
  StudyRunner& operator=(const StudyRunner&) = delete;

  /// Begins to run studies.
  void start();

  void enqueue(const Catalogue::Entry& entry);

  /// Takes a study out of the queue. @return whether it was there
  bool withdraw(const StudyEntry& entry);

  [[nodiscard]] std::size_t queued() const;

  /// Ends the runs after the blocks in flight, as far as they end soon, and waits for that. What waits is not begun.
  /// Idempotent.
  void stop();

  [[nodiscard]] unsigned threads() const { return threads_; }
  [[nodiscard]] std::uint64_t memory() const { return memory_; }  ///< [bytes] that running studies may need together
  [[nodiscard]] std::uint64_t trials_done() const { return trials_done_.load(std::memory_order_relaxed); }

 private:
  struct Waiting {
    Catalogue::Entry entry;
    unsigned overtaken;
  };
  struct Running {
    Catalogue::Entry entry;
    bool has_ended{false};
    std::thread thread{};
  };

  void dispatch();
  bool begin_next();
  void reap();
  void stop_overtime();
  void give_up_overdue();
  void keep_records(std::unique_lock<std::mutex>& lock);
  void run(Running& running);

  Catalogue& catalogue_;
  const unsigned threads_;
  const ServiceLimits limits_;
  const std::uint64_t memory_;
  const Tell tell_;
  const std::optional<Launcher> launcher_;
  Turnstile turns_;
  const SharedWorkers workers_;
  std::atomic<std::uint64_t> trials_done_{0};

  mutable std::mutex mutex_{};  // of what follows; taken before the catalogue's, never after
  std::condition_variable wake_{};
  std::deque<Waiting> queue_{};
  std::list<Running> running_{};
  std::vector<Catalogue::Entry> unkept_{};        // studies that are over, whose records could not be written
  StudyEntry::Clock::time_point next_keeping_{};  // when that is tried again
  bool stopping_{false};
  StudyEntry::Clock::time_point stopping_until_{StudyEntry::Clock::time_point::max()};  // then runs are given up
  std::thread dispatcher_{};
};

}  // namespace steerstat
