#include "store/part_header.hpp"

#include <fmt/format.h>

#include <cmath>

#include "store/attribute.hpp"
#include "store/layout.hpp"

namespace steerstat::hdf5 {
namespace {

void require_origin(hid_t file, const ShardOrigin& origin) {
  const std::string filetype = read_text_attribute(file, "filetype");
  if (filetype != layout::shard_filetype) {
    throw Problem(fmt::format("its filetype is '{}' (it must be '{}')", filetype, layout::shard_filetype));
  }
  const std::uint32_t format = read_integer_attribute(file, "format_version");
  if (format != layout::format_version) {
    throw Problem(fmt::format("it is of format {} (it must be {})", format, layout::format_version));
  }
  const std::string version = read_text_attribute(file, "engine_version");
  if (version != origin.engine_version) {
    throw Problem(fmt::format("it is of engine version {} (it must be {})", version, origin.engine_version));
  }
  if (read_text_attribute(file, "trials_sha256") != origin.trials_sha256) {
    throw Problem("its trials are another study's");
  }
}

}  // namespace

void write_part_header(hid_t file, const ShardOrigin& origin, double wall_s) {
  write_attribute(file, "filetype", std::string(layout::shard_filetype));
  write_attribute(file, "format_version", layout::format_version);
  write_attribute(file, "engine_version", origin.engine_version);
  write_attribute(file, "trials_sha256", origin.trials_sha256);
  write_attribute(file, "wall_s", wall_s);
}

double read_part_header(hid_t file, const ShardOrigin& origin) {
  require_origin(file, origin);
  const double wall_s = read_real_attribute(file, "wall_s");
  if (!std::isfinite(wall_s) || wall_s < 0.0) throw Problem("its wall_s is no duration");
  return wall_s;
}

}  // namespace steerstat::hdf5
