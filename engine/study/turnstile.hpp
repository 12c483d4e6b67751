#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>

namespace steerstat {

/// Lets several runs share the processors fairly: of all the workers that pass it, at most so many have a turn at once,
/// and whoever waits is served in the order of coming. A worker that gives way keeps its trials in flight as they are,
/// so sharing costs no lane its work, and no bit of an outcome. Thread-safe.
class Turnstile {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param permits  workers that may work at once, > 0
  /// @param quantum  how long a turn lasts at least while others wait
  explicit Turnstile(unsigned permits, Clock::duration quantum = std::chrono::milliseconds(10))
      : quantum_(quantum), free_(permits) {}
  Turnstile(const Turnstile&) = delete;
  Turnstile& operator=(const Turnstile&) = delete;

  /// The right to work, from its construction, which waits for it, to its end.
  class Turn {
   public:
    /// @param turnstile  null: there is nobody to share with, and nothing here costs anything
    explicit Turn(Turnstile* turnstile);
    ~Turn();
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

    /// Lets those who wait go first, where the turn has lasted its quantum; comes back with a turn.
    void give_way() {
      if (turnstile_ != nullptr && turnstile_->waiting_.load(std::memory_order_relaxed) > 0) offer();
    }

   private:
    void offer();

    Turnstile* const turnstile_;
    Clock::time_point began_{};
  };

 private:
  struct Waiter {
    std::condition_variable admitted_now{};
    bool admitted{false};
  };

  void wait_in_line(std::unique_lock<std::mutex>& lock);
  void admit_next();

  const Clock::duration quantum_;
  std::mutex mutex_{};
  unsigned free_;
  std::deque<Waiter*> line_{};
  std::atomic<unsigned> waiting_{0};  // length of the line
};

}  // namespace steerstat
