#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.hpp"

namespace steerstat {

/// A JSON value whose objects keep their keys in the document's order.
using Json = nlohmann::ordered_json;

/// Values may be nested this deep, the document itself being the first level.
inline constexpr std::size_t deepest_nesting = 32;

/// Parses a JSON document (RFC 8259).
///
/// @param duplicates  gets an error for every key that an object has twice; the first of them is the one that counts
/// @throws BadSpec with line and column for text that is not JSON, not UTF-8, nested too deep, or has a number that no
///         double holds
Json parse_json(std::string_view text, std::vector<SpecError>& duplicates);

/// Sorts errors into the order of the places they point to in the document.
void sort_by_place(std::vector<SpecError>& errors, const Json& document);

/// A JSON pointer's token for a key: "~" and "/" escaped (RFC 6901).
std::string pointer_token(std::string_view key);

/// Text from a spec as a message can show it: quoted, on one line, valid UTF-8, shortened to about 60 characters.
std::string quote(std::string_view text);

}  // namespace steerstat
