#include "service/live_outcomes.hpp"

#include <algorithm>
#include <mutex>

namespace steerstat {

void LiveOutcomes::open(std::span<const TrialOutcome> slots) {
  const std::unique_lock lock(mutex_);
  slots_ = slots;
  is_open_ = true;
  extend();
}

void LiveOutcomes::close() noexcept {
  const std::unique_lock lock(mutex_);
  is_open_ = false;
  slots_ = {};
}

void LiveOutcomes::take(std::uint64_t begin, std::span<const TrialOutcome> outcomes) {
  keeper_.take(begin, outcomes);
  const std::unique_lock lock(mutex_);
  kept_ += outcomes.size();
  if (begin == prefix_) prefix_ += outcomes.size();
  extend();
}

/// Steps over what was known before.
void LiveOutcomes::extend() {
  for (; next_known_ < known_.size() && known_[next_known_].begin <= prefix_; ++next_known_) {
    prefix_ = std::max(prefix_, known_[next_known_].end);
  }
}

}  // namespace steerstat
