#pragma once

#include <filesystem>

namespace steerstat {

/// A process's sole right to a directory, by flock(2) on the file `lock` in it. The system takes it back however the
/// process ends.
class DirectoryLock {
 public:
  /// @param directory  exists
  /// @throws RunFailure where another process has the directory, or where it cannot be locked
  explicit DirectoryLock(const std::filesystem::path& directory);
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

  /// The name of the file in the directory.
  static constexpr const char* file_name = "lock";

 private:
  int descriptor_{-1};
};

}  // namespace steerstat
