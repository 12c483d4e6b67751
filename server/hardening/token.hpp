#pragma once

#include <string>
#include <string_view>

namespace steerstat {

/// The shortest token that a token file may have; 32 hexadecimal digits are 128 bits.
inline constexpr std::size_t shortest_token = 16;

/// Reads the token that clients must show: the file's one line.
///
/// @throws BadUsage where it cannot be read, is open to other users, or has no token of at least shortest_token visible
///         ASCII characters
std::string read_token_file(const std::string& path);

/// Whether an Authorization header shows the token: `Bearer TOKEN`, or `Basic` with it as the password and any user, so
/// that browsers can ask for it. Takes as long for a wrong token as for the right one.
bool shows_token(std::string_view authorization, std::string_view token);

}  // namespace steerstat
