#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace steerstat {

/// How a trial ended. The numbers are stored in result files; never renumber them.
enum class Status : std::uint8_t {
  converged = 0,          ///< both errors within their tolerances
  timeout = 1,            ///< the horizon (or the cap on decisions) came first
  singular = 2,           ///< link 2 at rest stretched or folded: no actuation moves it (§3)
  diverged = 3,           ///< a non-finite or runaway state at a phase end
  integrator_failed = 4,  ///< the step size fell below 1e-12 s
};

inline constexpr std::array<std::string_view, 5> status_names{"converged", "timeout", "singular", "diverged",
                                                              "integrator_failed"};

constexpr std::string_view name_of(Status status) {
  return status_names[static_cast<std::size_t>(status)];
}

/// @return the status called `name`, or nothing where there is none.
constexpr std::optional<Status> status_named(std::string_view name) {
  for (std::size_t i = 0; i < status_names.size(); ++i) {
    if (status_names[i] == name) return static_cast<Status>(i);
  }
  return std::nullopt;
}

}  // namespace steerstat
