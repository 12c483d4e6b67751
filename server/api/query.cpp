#include "api/query.hpp"

#include <fmt/format.h>
#include <httplib.h>

#include <algorithm>
#include <charconv>

#include "hardening/problem.hpp"
#include "study/parse_json.hpp"

namespace steerstat {

std::optional<std::uint64_t> natural_number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

void expect_parameters(const httplib::Request& request, std::initializer_list<std::string_view> known) {
  for (const auto& [name, value] : request.params) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw Refused({400,
                     fmt::format("there is no query parameter {} here (known: {})", quote(name),
                                 known.size() == 0 ? "none" : fmt::format("{}", fmt::join(known, ", "))),
                     {},
                     {}});
    }
    if (request.params.count(name) > 1) {
      throw Refused({400, fmt::format("the query parameter {} is there more than once", name), {}, {}});
    }
  }
}

std::optional<std::string> parameter(const httplib::Request& request, const std::string& name) {
  if (!request.has_param(name)) return std::nullopt;
  return request.get_param_value(name);
}

std::optional<std::uint64_t> number_parameter(const httplib::Request& request, const std::string& name,
                                              std::uint64_t low, std::uint64_t high) {
  const std::optional<std::string> text = parameter(request, name);
  if (!text) return std::nullopt;
  const std::optional<std::uint64_t> value = natural_number(*text);
  if (!value || *value < low || *value > high) {
    throw Refused({400,
                   fmt::format("the query parameter {} is {} (a number from {} to {})", name, quote(*text), low, high),
                   {},
                   {}});
  }
  return value;
}

const std::string& json_body(const httplib::Request& request) {
  std::string type = request.get_header_value("Content-Type");
  type = type.substr(0, type.find(';'));
  while (!type.empty() && (type.back() == ' ' || type.back() == '\t')) type.pop_back();
  for (char& c : type) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  if (type != "application/json") {
    throw Refused({415,
                   "the body must be JSON and say so: Content-Type: application/json",
                   {},
                   {{"Accept", "application/json"}}});
  }
  return request.body;
}

}  // namespace steerstat
