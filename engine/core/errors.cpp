#include "core/errors.hpp"

namespace steerstat {
namespace {

std::string joined(const std::vector<SpecError>& errors) {
  std::string text;
  for (const SpecError& error : errors) {
    if (!text.empty()) text += '\n';
    text += error.pointer + ": " + error.detail;
  }
  return text;
}

}  // namespace

BadSpec::BadSpec(std::vector<SpecError> errors) : std::runtime_error(joined(errors)), errors_(std::move(errors)) {}

}  // namespace steerstat
