#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace steerstat {

/// One mistake in a study spec.
struct SpecError {
  std::string pointer;  ///< JSON pointer to the place (RFC 6901), "" for the document itself
  std::string detail;   ///< `problem (rule); suggestion`

  friend bool operator==(const SpecError&, const SpecError&) = default;
};

/// A spec was refused; carries every mistake found in it, in document order.
class BadSpec : public std::runtime_error {
 public:
  explicit BadSpec(std::vector<SpecError> errors);
  [[nodiscard]] const std::vector<SpecError>& errors() const { return errors_; }

 private:
  std::vector<SpecError> errors_;
};

/// The user asked for something that does not exist or makes no sense (exit code 2), other than through a spec.
class BadUsage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The run itself failed: I/O, a corrupt file, a full disk (exit code 4).
class RunFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace steerstat
