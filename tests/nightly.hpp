#pragma once

#include <cstdlib>
#include <string_view>

namespace steerstat::testing {

/// Whether `tests/run nightly` runs the tests: those that compare samples then take large ones.
inline bool is_nightly() {
  const char* const asked = std::getenv("STEERSTAT_NIGHTLY");  // NOLINT(concurrency-mt-unsafe): nothing sets it
  return asked != nullptr && std::string_view(asked) == "1";
}

/// Whether a sanitizer slows the tests down.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif

}  // namespace steerstat::testing
