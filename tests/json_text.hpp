#pragma once

#include <iosfwd>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

/// nlohmann's parser and writer, compiled once: in every test that needs them they would take the sanitizers' builds
/// half of their time.
namespace steerstat::testing {

/// @throws nlohmann::json::parse_error
nlohmann::json json_of(std::string_view text);

/// With keys in the text's order. @throws nlohmann::json::parse_error
nlohmann::ordered_json ordered_json_of(std::string_view text);

/// Compact.
std::string text_of(const nlohmann::json& json);
std::string text_of(const nlohmann::ordered_json& json);

}  // namespace steerstat::testing

namespace nlohmann {

/// How GoogleTest shows a value, found by the value's namespace.
void PrintTo(const json& value, std::ostream* stream);
void PrintTo(const ordered_json& value, std::ostream* stream);

}  // namespace nlohmann
