#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

namespace httplib {
struct Request;
}  // namespace httplib

namespace steerstat {

/// Decodes a number of decimal digits. @return nothing where it is none, or none that 64 bits hold
std::optional<std::uint64_t> natural_number(std::string_view text);

/// Checks that a request has no query parameters but these, each once. @throws Refused 400
void expect_parameters(const httplib::Request& request, std::initializer_list<std::string_view> known);

/// A query parameter; nothing where it is not there.
std::optional<std::string> parameter(const httplib::Request& request, const std::string& name);

/// A query parameter that is a number in [low, high]. @throws Refused 400
std::optional<std::uint64_t> number_parameter(const httplib::Request& request, const std::string& name,
                                              std::uint64_t low, std::uint64_t high);

/// The JSON document that a request brings. @throws Refused 415 where its Content-Type is another
const std::string& json_body(const httplib::Request& request);

}  // namespace steerstat
