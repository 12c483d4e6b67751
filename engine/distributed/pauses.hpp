#pragma once

#include <algorithm>
#include <chrono>
#include <thread>

namespace steerstat {

/// Pauses between looks for messages. MPI's own waiting keeps a core busy, which trials can use; and so does looking
/// often. Short after a message, as more may follow, then longer: little against the time that a range takes.
class Pauses {
 public:
  /// Sleeps: half a millisecond, and twice as long every time, up to four.
  void pause() {
    std::this_thread::sleep_for(next_);
    next_ = std::min(2 * next_, longest);
  }

  /// A message has come.
  void begin_anew() { next_ = shortest; }

 private:
  static constexpr std::chrono::microseconds shortest{500};
  static constexpr std::chrono::microseconds longest{4000};
  std::chrono::microseconds next_{shortest};
};

}  // namespace steerstat
