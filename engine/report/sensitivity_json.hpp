#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "report/sensitivity.hpp"

namespace steerstat {

/// A summary's `sensitivity`: null where the sampling is not sobol_indices.
nlohmann::ordered_json sobol_json(const std::optional<SobolSensitivity>& sobol);

}  // namespace steerstat
