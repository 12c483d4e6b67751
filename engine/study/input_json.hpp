#pragma once

#include <optional>

#include "study/inputs.hpp"
#include "study/reader_json.hpp"
#include "study/study.hpp"

namespace steerstat {

/// Decodes one number that may vary: a number, a distribution or a sweep, none of whose values may be out of the
/// input's range.
///
/// @param nominal  of a plant input, the nominal value, which a relative distribution multiplies; nothing where it is
///                 itself mistaken
/// @return nothing where a mistake was noted
std::optional<InputValue> decode_input(const InputDefinition& definition, std::optional<double> nominal,
                                       const Reader& reader);

/// An input's value as a spec writes it.
nlohmann::json encode_input(const InputValue& value);

}  // namespace steerstat
