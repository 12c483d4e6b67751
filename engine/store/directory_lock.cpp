#include "store/directory_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "core/errors.hpp"

namespace steerstat {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& directory, int error) {
  throw RunFailure(fmt::format("cannot lock {} ({})", directory.string(), std::generic_category().message(error)));
}

/// The number of the process that wrote it into the lock file; "" where there is none.
std::string owner(int descriptor) {
  char text[24];
  const ssize_t count = ::pread(descriptor, text, sizeof text, 0);
  std::string number(text, static_cast<std::size_t>(count < 0 ? 0 : count));
  return number.substr(0, number.find('\n'));
}

/// Says who has the lock, for whoever comes second. Only a message depends on it, so it may fail.
void sign(int descriptor) {
  const std::string text = fmt::format("{}\n", ::getpid());
  if (::ftruncate(descriptor, 0) != 0 || ::pwrite(descriptor, text.data(), text.size(), 0) < 0) return;
}

/// Whether `path` still names the open file: whoever had the directory before may have removed both in between.
bool still_named(int descriptor, const fs::path& path) {
  struct stat open {};
  struct stat named {};
  return ::fstat(descriptor, &open) == 0 && ::stat(path.c_str(), &named) == 0 && open.st_ino == named.st_ino &&
         open.st_dev == named.st_dev;
}

}  // namespace

DirectoryLock::DirectoryLock(const fs::path& directory) {
  const fs::path path = directory / file_name;
  descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(directory, errno);
  int error = 0;
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    error = errno;
  } else if (!still_named(descriptor_, path)) {
    error = EWOULDBLOCK;
  }
  if (error == 0) {
    sign(descriptor_);
    return;
  }
  const std::string process = owner(descriptor_);
  ::close(descriptor_);
  if (error != EWOULDBLOCK) fail(directory, error);
  throw RunFailure(fmt::format("{} is in use by another process{}; wait until it has ended, or end it",
                               directory.string(), process.empty() ? "" : fmt::format(" ({})", process)));
}

DirectoryLock::~DirectoryLock() {
  ::close(descriptor_);
}

}  // namespace steerstat
