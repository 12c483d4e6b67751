#pragma once

#include <exception>
#include <stop_token>

#include "study/turnstile.hpp"

namespace steerstat {

/// A run was to end before its blocks in flight had; what had finished before them is with the sink.
class RunGivenUp : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "the run was given up"; }
};

/// What a worker does every few milliseconds of trials that take long: lets others have their turn, or gives up.
/// @throws RunGivenUp after a request
inline void check_in(Turnstile::Turn& turn, const std::stop_token& give_up) {
  if (give_up.stop_requested()) throw RunGivenUp();
  turn.give_way();
}

}  // namespace steerstat
