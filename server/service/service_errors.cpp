#include "service/service_errors.hpp"

#include <fmt/format.h>

namespace steerstat {

LimitExceeded::LimitExceeded(std::vector<SpecError> errors)
    : std::runtime_error(errors.empty() ? "too much" : errors.front().pointer + ": " + errors.front().detail),
      errors_(std::move(errors)) {}

TakesTooLong::TakesTooLong(std::chrono::milliseconds limit)
    : std::runtime_error(fmt::format("the trial takes longer than the {} s that it may while a client waits",
                                     std::chrono::duration<double>(limit).count())) {}

std::function<void()> within(std::chrono::milliseconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  return [limit, end] {
    if (std::chrono::steady_clock::now() > end) throw TakesTooLong(limit);
  };
}

NoSuchStudy::NoSuchStudy(const std::string& id) : std::runtime_error("there is no study " + id) {}

}  // namespace steerstat
