#include "store/free_space.hpp"

#include <fmt/format.h>
#include <sys/statvfs.h>

#include <algorithm>

#include "core/errors.hpp"

namespace steerstat {
namespace {

constexpr std::uint64_t largest_reserve = std::uint64_t{64} << 20;

std::uint64_t mebibytes_up(std::uint64_t bytes) {
  return (bytes + (std::uint64_t{1} << 20) - 1) >> 20;
}

}  // namespace

void require_free_space(const std::filesystem::path& directory, std::uint64_t bytes) {
  struct statvfs status {};
  if (::statvfs(directory.c_str(), &status) != 0 || status.f_blocks == 0) return;
  const std::uint64_t unit = status.f_frsize;
  const std::uint64_t free = unit * status.f_bavail;
  const std::uint64_t needed = bytes + std::min(unit * status.f_blocks / 64, largest_reserve);
  if (free >= needed) return;
  throw RunFailure(fmt::format("cannot write in {} (the disk is full: {} MiB free, {} MiB needed); make room",
                               directory.string(), free >> 20, mebibytes_up(needed)));
}

}  // namespace steerstat
