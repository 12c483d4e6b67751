#include "study/turnstile.hpp"

namespace steerstat {

Turnstile::Turn::Turn(Turnstile* turnstile) : turnstile_(turnstile) {
  if (turnstile_ == nullptr) return;
  {
    std::unique_lock lock(turnstile_->mutex_);
    if (turnstile_->free_ > 0) {
      --turnstile_->free_;  // nobody is in line then: a turn that ends goes to the first in it
    } else {
      turnstile_->wait_in_line(lock);
    }
  }
  began_ = Clock::now();
}

Turnstile::Turn::~Turn() {
  if (turnstile_ == nullptr) return;
  const std::lock_guard lock(turnstile_->mutex_);
  turnstile_->admit_next();
}

void Turnstile::Turn::offer() {
  if (Clock::now() - began_ < turnstile_->quantum_) return;
  {
    std::unique_lock lock(turnstile_->mutex_);
    if (turnstile_->line_.empty()) return;
    turnstile_->admit_next();
    turnstile_->wait_in_line(lock);
  }
  began_ = Clock::now();
}

void Turnstile::wait_in_line(std::unique_lock<std::mutex>& lock) {
  Waiter waiter;
  line_.push_back(&waiter);
  waiting_.fetch_add(1, std::memory_order_relaxed);
  waiter.admitted_now.wait(lock, [&] { return waiter.admitted; });
}

void Turnstile::admit_next() {
  if (line_.empty()) {
    ++free_;
    return;
  }
  Waiter& first = *line_.front();
  line_.pop_front();
  waiting_.fetch_sub(1, std::memory_order_relaxed);
  first.admitted = true;
  first.admitted_now.notify_one();  // under the lock: once it is let go, the waiter may be gone
}

}  // namespace steerstat
