#include "json_text.hpp"

#include <ostream>

namespace steerstat::testing {

nlohmann::json json_of(std::string_view text) {
  return nlohmann::json::parse(text);
}

nlohmann::ordered_json ordered_json_of(std::string_view text) {
  return nlohmann::ordered_json::parse(text);
}

std::string text_of(const nlohmann::json& json) {
  return json.dump();
}

std::string text_of(const nlohmann::ordered_json& json) {
  return json.dump();
}

}  // namespace steerstat::testing

namespace nlohmann {

void PrintTo(const json& value, std::ostream* stream) {
  *stream << value.dump();
}

void PrintTo(const ordered_json& value, std::ostream* stream) {
  *stream << value.dump();
}

}  // namespace nlohmann
