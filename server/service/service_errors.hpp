#pragma once

#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.hpp"

namespace steerstat {

/// A valid spec asks for more than the service grants.
class LimitExceeded : public std::runtime_error {
 public:
  explicit LimitExceeded(std::vector<SpecError> errors);
  /// What is too much, at least one.
  [[nodiscard]] const std::vector<SpecError>& errors() const { return errors_; }

 private:
  std::vector<SpecError> errors_;
};

/// No further study is taken now.
class QueueFull : public std::runtime_error {
 public:
  QueueFull(const std::string& what, unsigned retry_after) : std::runtime_error(what), retry_after_(retry_after) {}
  [[nodiscard]] unsigned retry_after() const { return retry_after_; }  ///< [s] when to ask again

 private:
  unsigned retry_after_;
};

/// A trial that a client waits for takes longer than it may.
class TakesTooLong : public std::runtime_error {
 public:
  explicit TakesTooLong(std::chrono::milliseconds limit);
};

/// A check_in() that throws TakesTooLong once so much time has gone by.
std::function<void()> within(std::chrono::milliseconds limit);

/// There is no study of that id.
class NoSuchStudy : public std::runtime_error {
 public:
  explicit NoSuchStudy(const std::string& id);
};

/// The study has no such trial, or has not finished it.
class NoSuchTrial : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace steerstat
