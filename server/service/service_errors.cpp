#include "service/service_errors.hpp"

namespace steerstat {

LimitExceeded::LimitExceeded(std::vector<SpecError> errors)
    : std::runtime_error(errors.empty() ? "too much" : errors.front().pointer + ": " + errors.front().detail),
      errors_(std::move(errors)) {}

NoSuchStudy::NoSuchStudy(const std::string& id) : std::runtime_error("there is no study " + id) {}

}  // namespace steerstat
