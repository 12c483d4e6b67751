#include "study/rate.hpp"

#include <algorithm>
#include <array>

namespace steerstat {
namespace {

// In the order of Status, after success_rate.
constexpr std::array<std::string_view, status_names.size() + 1> rates{
    "success_rate", "converged_rate", "timeout_rate", "singular_rate", "diverged_rate", "integrator_failed_rate"};

}  // namespace

std::span<const std::string_view> rate_names() {
  return rates;
}

std::optional<Status> outcome_of_rate(std::string_view name) {
  const auto found = std::find(rates.begin(), rates.end(), name);
  if (found == rates.end()) return std::nullopt;
  return found == rates.begin() ? Status::converged : static_cast<Status>(found - rates.begin() - 1);
}

}  // namespace steerstat
