#include "store/study_files.hpp"

#include <fmt/format.h>

#include <system_error>

#include "core/errors.hpp"

namespace steerstat {

void remove_file(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::remove(path, error);
  if (error) throw RunFailure(fmt::format("cannot delete {} ({})", path.string(), error.message()));
}

}  // namespace steerstat
