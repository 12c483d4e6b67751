#pragma once

#include <atomic>
#include <cstddef>
#include <memory>

namespace steerstat {

/// A share of the workers that one kind of request may occupy at once, so that others find some free. Thread-safe.
class Share {
 public:
  explicit Share(std::size_t places) : taken_(std::make_shared<std::atomic<std::size_t>>(0)), places_(places) {}

  /// Takes a place for as long as the result lives. @return nothing where all are taken
  [[nodiscard]] std::shared_ptr<void> take() {
    std::size_t taken = *taken_;
    do {
      if (taken >= places_) return nullptr;
    } while (!taken_->compare_exchange_weak(taken, taken + 1));
    return {taken_.get(), [kept = taken_](void*) { --*kept; }};
  }

  [[nodiscard]] std::size_t taken() const { return *taken_; }

 private:
  std::shared_ptr<std::atomic<std::size_t>> taken_;
  std::size_t places_;
};

}  // namespace steerstat
