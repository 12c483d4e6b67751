#pragma once

#include <stop_token>
#include <thread>

namespace steerstat {

/// While it lives, the first SIGINT or SIGTERM requests a stop, and the one after it ends the process at once. One at a
/// time; signals are the process's.
class Interruption {
 public:
  /// @throws RunFailure where the system has no pipe left
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }

 private:
  std::stop_source stop_;
  int read_end_{-1};
  std::thread listener_;
};

}  // namespace steerstat
