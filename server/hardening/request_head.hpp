#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hardening/door_limits.hpp"
#include "hardening/problem.hpp"

namespace steerstat {

/// A request's head, of whose framing there can be no two opinions.
struct RequestHead {
  std::string method;
  std::string target;  ///< origin form, visible ASCII, begins with "/"
  bool http_1_0{false};
  std::vector<std::pair<std::string, std::string>> fields;  ///< names in lower case, values without white space around
  std::size_t content_length{0};
  bool expects_continue{false};
  bool keeps_alive{false};  ///< whether another request may follow on the connection

  /// The value of a field that is there at most once, "" where it is not. @param name  lower case
  [[nodiscard]] std::string_view field(std::string_view name) const;
  [[nodiscard]] bool has(std::string_view name) const;
};

/// Parses a head [RFC 9112], stricter than it must be: CRLF alone ends lines, no folded lines, no white space before a
/// colon, no control characters, and of the fields that frame or guard a request (Content-Length, Host, Authorization,
/// Content-Type, Origin, ...) at most one each. Bodies are framed by Content-Length alone, plain, and come with POST
/// alone. Pure and thread-safe.
///
/// @param text  all up to and with the empty line
/// @throws Refused 400, 411, 413, 414, 415, 417, 431 or 505
RequestHead parse_head(std::string_view text, const DoorLimits& limits);

}  // namespace steerstat
