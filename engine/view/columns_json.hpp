#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/status.hpp"
#include "view/axis.hpp"
#include "view/distribution.hpp"
#include "view/success_map.hpp"

/// What the views' documents have in common.
namespace steerstat::view_json {

using Json = nlohmann::ordered_json;

/// Significant digits of a column, which a picture does not tell from more.
inline constexpr int shown_digits = 6;

/// x rounded to so many significant digits, so that its shortest text is short; null where it is not finite.
Json number(double x, int digits = shown_digits);

Json number_or_null(std::optional<double> x);

/// A column of numbers, each as number().
Json numbers(std::span<const double> column, int digits = shown_digits);

/// A column of statuses as their numbers.
Json statuses(std::span<const Status> column);

Json identity(const StudyIdentity& identity);
Json axis(const Axis& axis);
Json distribution(const EmpiricalDistribution& distribution);
Json success_map(const SuccessMap& map);

/// The document's text, ending in a newline.
std::string text(const Json& document);

}  // namespace steerstat::view_json
