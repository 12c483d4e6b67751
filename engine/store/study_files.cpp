#include "store/study_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "core/errors.hpp"

namespace steerstat {

namespace fs = std::filesystem;

void fail_at(const char* verb, const fs::path& path, const std::error_code& error) {
  throw RunFailure(fmt::format("cannot {} {} ({})", verb, path.string(), error.message()));
}

std::vector<fs::path> files_in(const fs::path& directory, std::initializer_list<const char*> prefixes) {
  std::error_code error;
  std::vector<fs::path> found;
  fs::directory_iterator entry(directory, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    for (const char* const prefix : prefixes) {
      if (name.starts_with(prefix)) found.push_back(entry->path());
    }
  }
  if (error) fail_at("list", directory, error);
  std::sort(found.begin(), found.end());
  return found;
}

void remove_file(const fs::path& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error) fail_at("delete", path, error);
}

}  // namespace steerstat
