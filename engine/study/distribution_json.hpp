#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "sampling/distribution.hpp"
#include "study/reader_json.hpp"

namespace steerstat {

/// The keys that a distribution may have in a spec, one a shape.
inline constexpr std::array<std::string_view, 6> distribution_names{"uniform",   "normal",     "truncated_normal",
                                                                    "lognormal", "triangular", "discrete"};

/// Decodes what stands under a distribution's key, e.g. the `[0.8, 1.2]` of `{"uniform": [0.8, 1.2]}`.
///
/// @param name    one of distribution_names
/// @param reader  the value of that key
/// @return nothing where a mistake was noted
std::optional<Distribution::Shape> decode_shape(std::string_view name, const Reader& reader);

/// A distribution as a spec writes it.
nlohmann::json encode_distribution(const Distribution& distribution);

}  // namespace steerstat
