#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace steerstat {

/// Some bytes of a file.
struct ByteRange {
  std::uint64_t begin{0};
  std::uint64_t size{0};  ///< 0: none of those asked for is there
  friend bool operator==(const ByteRange&, const ByteRange&) = default;
};

/// The one range of a Range header [RFC 9110, 14.2]: `bytes=5-9`, `bytes=5-`, `bytes=-5`. A list of ranges, and what is
/// none, is nothing: the file is sent whole then, as the standard allows.
///
/// @param size  of the file
std::optional<ByteRange> single_range(std::string_view header, std::uint64_t size);

}  // namespace steerstat
