#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "core/status.hpp"

namespace steerstat {

/// The rates that stand beside the metrics: success_rate, then `OUTCOME_rate` for every outcome. Shares of all finished
/// trials.
std::span<const std::string_view> rate_names();

/// The outcome whose share is called so; success_rate is that of converged. @return nothing for what is no rate
std::optional<Status> outcome_of_rate(std::string_view name);

}  // namespace steerstat
