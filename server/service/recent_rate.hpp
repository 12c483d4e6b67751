#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

namespace steerstat {

/// How fast a count grows, over the last seconds.
class RecentRate {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param count  not less than before
  /// @return [1/s] nothing until it can be told
  std::optional<double> add(Clock::time_point now, std::uint64_t count) {
    seen_.emplace_back(now, count);
    while (seen_.size() > 2 && now - seen_[1].first >= window) seen_.pop_front();
    const std::chrono::duration<double> span = now - seen_.front().first;
    if (span < shortest) return std::nullopt;
    return static_cast<double>(count - seen_.front().second) / span.count();
  }

 private:
  static constexpr std::chrono::seconds window{5};
  static constexpr std::chrono::milliseconds shortest{100};
  std::deque<std::pair<Clock::time_point, std::uint64_t>> seen_{};
};

}  // namespace steerstat
