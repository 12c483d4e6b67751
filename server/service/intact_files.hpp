#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <set>

namespace steerstat {

/// Sealed files that were found whole: each is read through once, as long as it stays the file that it was (by inode,
/// size and time of change). Thread-safe.
class IntactFiles {
 public:
  /// @throws RunFailure where the file is damaged or cannot be read
  void require(const std::filesystem::path& path);

 private:
  /// What tells a file from what stood in its place, or stands there later.
  using Identity = std::array<std::int64_t, 5>;

  static Identity identity_of(const std::filesystem::path& path);
  [[nodiscard]] bool knows(const Identity& file);

  std::mutex checking_{};  // one is read at a time
  std::mutex mutex_{};
  std::set<Identity> known_{};
};

}  // namespace steerstat
