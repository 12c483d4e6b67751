#include "store/whole_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <random>
#include <system_error>
#include <utility>

#include "core/errors.hpp"
#include "store/failpoint.hpp"
#include "store/free_space.hpp"
#include "store/result_file.hpp"
#include "store/study_files.hpp"

namespace steerstat {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const char* verb, const fs::path& path, int error, const char* advice = "") {
  throw RunFailure(
      fmt::format("cannot {} {} ({}){}", verb, path.string(), std::generic_category().message(error), advice));
}

/// An open file, closed at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] bool is_open() const { return number_ >= 0; }
  [[nodiscard]] int number() const { return number_; }
  /// @return 0 or the error: some file systems report the last writes here
  int close() { return ::close(std::exchange(number_, -1)) == 0 ? 0 : errno; }

 private:
  int number_;
};

/// @return 0 or the error
int write_all(const Descriptor& file, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file.number(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return 0;
}

int write_all(const Descriptor& file, std::initializer_list<std::span<const std::byte>> parts) {
  for (const auto part : parts) {
    if (const int error = write_all(file, part); error != 0) return error;
  }
  return 0;
}

std::uint64_t total_size(std::initializer_list<std::span<const std::byte>> parts) {
  std::uint64_t size = 0;
  for (const auto part : parts) size += part.size();
  return size;
}

fs::path directory_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// How the names of this process's temporary files begin, and those of no other, of another machine either.
std::string own_prefix() {
  static const unsigned process = std::random_device{}();
  return fmt::format("{}{}-{:08x}-", temporary_prefix, ::getpid(), process);
}

/// A name in a directory that no other write uses.
fs::path temporary_in(const fs::path& directory) {
  static std::atomic<unsigned> count{0};
  return directory / fmt::format("{}{}", own_prefix(), count++);
}

/// A new, empty file. What an earlier process of the same number left behind is in nobody's use.
Descriptor create(const fs::path& path) {
  ::unlink(path.c_str());
  return Descriptor(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
}

/// Does one step of writing, in between what tests let fail. @param action  returns 0 or the error
template <class Action>
int step(const char* name, const Action& action) {
  if (const int error = failpoint(Moment::before, name); error != 0) return error;
  if (const int error = action(); error != 0) return error;
  return failpoint(Moment::after, name);
}

/// Makes a change in `directory` last. @return 0 or the error
int sync(const fs::path& directory) {
  const Descriptor opened(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!opened.is_open()) return errno;
  if (::fsync(opened.number()) == 0) return 0;
  return errno == EINVAL || errno == ENOTSUP ? 0 : errno;  // file systems that cannot, say so
}

/// Writes a new file that is on the disk before it gets its name. @return 0 or the error
int write_and_rename(const fs::path& temporary, const fs::path& target,
                     std::initializer_list<std::span<const std::byte>> parts) {
  Descriptor file = create(temporary);
  if (!file.is_open()) return errno;
  int error = write_all(file, parts);
  if (error == 0) error = step("fsync", [&] { return ::fsync(file.number()) == 0 ? 0 : errno; });
  if (error == 0) error = step("close", [&] { return file.close(); });
  if (error != 0) return error;
  return step("rename", [&] { return std::rename(temporary.c_str(), target.c_str()) == 0 ? 0 : errno; });
}

/// The status of what `path` leads to, links followed; of type not_found where there is nothing.
fs::file_status status_of(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::none) fail("write", path, error.value());
  return status;
}

bool written_in_place(const fs::file_status& status) {
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

/// Where the bytes go: the file that a link names, not the link.
fs::path resolved(const fs::path& path, const fs::file_status& status) {
  return fs::is_regular_file(status) ? fs::canonical(path) : path;
}

}  // namespace

void write_whole_file(const fs::path& path, std::initializer_list<std::span<const std::byte>> parts,
                      const fs::path& workshop, Reserve reserve) {
  const fs::file_status status = status_of(path);
  if (written_in_place(status)) {
    Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
    if (!file.is_open()) fail("write", path, errno);
    int error = write_all(file, parts);
    if (const int closing = file.close(); error == 0) error = closing;
    if (error != 0) fail("write", path, error);
    return;
  }
  const fs::path target = resolved(path, status);
  if (reserve == Reserve::stays) require_free_space(directory_of(target), total_size(parts));
  const fs::path temporary = temporary_in(workshop.empty() ? directory_of(target) : workshop);
  if (const int error = write_and_rename(temporary, target, parts); error != 0) {
    ::unlink(temporary.c_str());
    fail("write", path, error);
  }
  sync_directory(directory_of(target));
}

bool is_own_temporary(const fs::path& path) {
  return path.filename().string().starts_with(own_prefix());
}

void sync_directory(const fs::path& directory) {
  const int error = step("directory-fsync", [&] { return sync(directory); });
  if (error != 0) fail("sync the directory", directory, error);
}

std::vector<std::byte> read_whole_file(const fs::path& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat status {};
  if (!file.is_open() || ::fstat(file.number(), &status) != 0) fail("read", path, errno);
  std::vector<std::byte> bytes;
  std::size_t filled = 0;
  // One byte more than the file has, so that its end is seen without growing the buffer.
  bytes.resize(static_cast<std::size_t>(std::max<off_t>(status.st_size, 0)) + 1);
  while (true) {
    if (filled == bytes.size()) bytes.resize(2 * bytes.size());
    const ssize_t count = ::read(file.number(), bytes.data() + filled, bytes.size() - filled);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("read", path, errno);
    if (count == 0) break;
    filled += static_cast<std::size_t>(count);
  }
  bytes.resize(filled);
  return bytes;
}

void require_writable(const fs::path& path) {
  if (path.empty()) throw RunFailure("cannot write a file without a name; give one");
  const fs::file_status status = status_of(path);
  if (fs::is_directory(status)) fail("write", path, EISDIR, "; name a file in it");
  if (fs::exists(status) && ::access(path.c_str(), W_OK) != 0) fail("write", path, errno);
  if (written_in_place(status)) return;
  const fs::path target = resolved(path, status);
  const fs::path directory = directory_of(target);
  if (!fs::exists(status_of(directory))) {
    throw RunFailure(
        fmt::format("cannot write {} (there is no directory {}); create it", path.string(), directory.string()));
  }
  // Only a try tells: permissions, read-only file systems and quotas all count. Where the file system allows, by a file
  // without a name, which leaves nothing behind when the process is killed.
  if (const Descriptor nameless(::open(directory.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666));
      nameless.is_open()) {
    return;
  }
  const fs::path temporary = temporary_in(directory);
  Descriptor file = create(temporary);
  if (!file.is_open()) fail("write", path, errno);
  ::unlink(temporary.c_str());
}

}  // namespace steerstat
