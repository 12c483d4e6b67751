#pragma once

#include <string>
#include <string_view>

namespace steerstat {

/// Reads a text that the user names: a spec, a baseline.
///
/// @param name    the file, or "-" for standard input
/// @param what    what a message calls it: "a spec"
/// @param advice  what to do where it is far larger than such a text is
/// @throws BadUsage where it cannot be read or is larger than 64 MiB
std::string read_text(const std::string& name, std::string_view what, std::string_view advice);

}  // namespace steerstat
