#pragma once

#include <span>
#include <string>
#include <vector>

#include "study/reader_json.hpp"
#include "study/study.hpp"

namespace steerstat {

/// Decodes a spec's `sampling.correlation`, a list of [name, name, correlation].
///
/// @param inputs    decoded: only those with distributions can be correlated
/// @param mistaken  names of the inputs that have mistakes of their own: what they are is not known
/// @return positive definite, in the order of input_names(), without those that are 0; where mistakes were noted, none
std::vector<Correlation> decode_correlations(const Reader& reader, std::span<const Input> inputs,
                                             std::span<const std::string> mistaken);

/// Correlations as a spec writes them.
nlohmann::json encode_correlations(std::span<const Correlation> correlations);

}  // namespace steerstat
