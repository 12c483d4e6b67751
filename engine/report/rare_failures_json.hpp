#pragma once

#include <nlohmann/json_fwd.hpp>

#include "report/rare_failures.hpp"

namespace steerstat {

/// A summary's `rare_failures` (schemas/summary.schema.json); null where there are none.
nlohmann::ordered_json rare_failures_json(const std::optional<RareFailures>& rare);

}  // namespace steerstat
