#pragma once

#include <time.h>

#include <algorithm>
#include <chrono>

namespace steerstat {

/// Measures what it takes to make what is shown of a running study, and so tells how long it is to hold. Counts the
/// time of the calling thread's own work: not its waiting for a run to begin, nor for cores that the trials keep busy.
class RefreshTimer {
 public:
  using Clock = std::chrono::steady_clock;

  /// To be called by the thread that made it.
  /// @return when it is to be made anew: readers of one study take a fifth of a core at most, and as much again for
  ///         each thread that helped
  [[nodiscard]] Clock::time_point due() const {
    return Clock::now() + std::max<Clock::duration>(shortest, 4 * (worked() - start_));
  }

 private:
  static constexpr std::chrono::milliseconds shortest{300};

  static std::chrono::nanoseconds worked() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);  // cannot fail: Linux has this clock
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
  }

  std::chrono::nanoseconds start_{worked()};
};

}  // namespace steerstat
