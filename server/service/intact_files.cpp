#include "service/intact_files.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <system_error>

#include "core/errors.hpp"
#include "store/seal.hpp"

namespace steerstat {

void IntactFiles::require(const std::filesystem::path& path) {
  const Identity file = identity_of(path);
  if (knows(file)) return;
  const std::lock_guard checking(checking_);
  if (knows(file)) return;  // read while this one waited
  if (!is_sealed(path)) {
    throw RunFailure(
        fmt::format("cannot read {}: it is damaged, cut short or was changed since it was written", path.string()));
  }
  const std::lock_guard lock(mutex_);
  known_.insert(file);
}

IntactFiles::Identity IntactFiles::identity_of(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    throw RunFailure(fmt::format("cannot read {} ({})", path.string(), std::generic_category().message(errno)));
  }
  return {static_cast<std::int64_t>(status.st_dev), static_cast<std::int64_t>(status.st_ino), status.st_size,
          status.st_ctim.tv_sec, status.st_ctim.tv_nsec};
}

bool IntactFiles::knows(const Identity& file) {
  const std::lock_guard lock(mutex_);
  return known_.contains(file);
}

}  // namespace steerstat
