#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "service/study_entry.hpp"
#include "service/study_home.hpp"
#include "store/directory_lock.hpp"

namespace steerstat {

/// The directory that the service keeps everything in. One process at a time has it.
class DataDirectory {
 public:
  /// Takes it, making it where there is none. @throws RunFailure naming it
  explicit DataDirectory(const std::filesystem::path& path);

  [[nodiscard]] const std::filesystem::path& studies() const { return studies_; }
  [[nodiscard]] StudyHome home_of(const std::string& id) const { return StudyHome(studies_ / id); }

  /// Every study there is, in any order. Reads no trials. Removes what was being made or removed when an earlier
  /// process died; what cannot be read is set aside and told.
  [[nodiscard]] std::vector<std::shared_ptr<StudyEntry>> recover(
      const std::function<void(const std::string&)>& tell) const;

 private:
  std::filesystem::path studies_;
  std::unique_ptr<DirectoryLock> lock_;
};

}  // namespace steerstat
