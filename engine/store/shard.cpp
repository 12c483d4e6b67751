#include "store/shard.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <optional>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "store/attribute.hpp"
#include "store/column.hpp"
#include "store/layout.hpp"
#include "store/memory_file.hpp"
#include "store/seal.hpp"
#include "store/trial_columns.hpp"
#include "store/whole_file.hpp"
#include "study/continuation.hpp"

namespace steerstat {
namespace {

using hdf5::Problem;

hdf5::Bytes shard_bytes(const ShardOrigin& origin, std::uint64_t begin, std::span<const TrialOutcome> outcomes,
                        double wall_s) {
  const hdf5::Session session;
  hdf5::MemoryFile file;
  hdf5::write_attribute(file.id(), "filetype", std::string(layout::shard_filetype));
  hdf5::write_attribute(file.id(), "format_version", layout::format_version);
  hdf5::write_attribute(file.id(), "engine_version", origin.engine_version);
  hdf5::write_attribute(file.id(), "trials_sha256", origin.trials_sha256);
  hdf5::write_attribute(file.id(), "wall_s", wall_s);
  {
    const hdf5::Handle trials = hdf5::create_group(file.id(), "trials");
    std::vector<std::uint64_t> index(outcomes.size());
    std::iota(index.begin(), index.end(), begin);
    hdf5::write_column<std::uint64_t>(trials.id(), "index", index, "1");
    hdf5::write_outcomes(trials.id(), outcomes);
  }
  return file.close();
}

void require_origin(hid_t file, const ShardOrigin& origin) {
  const std::string filetype = hdf5::read_text_attribute(file, "filetype");
  if (filetype != layout::shard_filetype) {
    throw Problem(fmt::format("its filetype is '{}' (it must be '{}')", filetype, layout::shard_filetype));
  }
  const std::uint32_t format = hdf5::read_integer_attribute(file, "format_version");
  if (format != layout::format_version) {
    throw Problem(fmt::format("it is of format {} (it must be {})", format, layout::format_version));
  }
  const std::string version = hdf5::read_text_attribute(file, "engine_version");
  if (version != origin.engine_version) {
    throw Problem(fmt::format("it is of engine version {} (it must be {})", version, origin.engine_version));
  }
  if (hdf5::read_text_attribute(file, "trials_sha256") != origin.trials_sha256) {
    throw Problem("its trials are another study's");
  }
}

Shard read_bytes(std::span<const std::byte> bytes, const ShardOrigin& origin, std::uint64_t trials) {
  const hdf5::Session session;
  const hdf5::Handle file = hdf5::open_in_memory(bytes);
  require_origin(file.id(), origin);
  Shard shard;
  shard.wall_s = hdf5::read_real_attribute(file.id(), "wall_s");
  if (!std::isfinite(shard.wall_s) || shard.wall_s < 0.0) throw Problem("its wall_s is no duration");
  const hdf5::Handle group = hdf5::open_group(file.id(), "trials");
  const std::vector<std::uint64_t> index = hdf5::read_index(group.id(), trials);
  if (index.empty() || index.back() - index.front() != index.size() - 1) {
    throw Problem("/trials/index is not one of consecutive trials");
  }
  shard.begin = index.front();
  if (!hdf5::has_every_outcome(group.id())) throw Problem("it lacks metrics");
  shard.outcomes = hdf5::read_outcomes(group.id(), {0, index.size(), index.size()});
  return shard;
}

}  // namespace

ShardOrigin origin_of(const Study& study) {
  return {std::string(engine_version()), trials_sha256(study)};
}

std::string shard_name(std::uint64_t begin, std::uint64_t end) {
  return fmt::format("trials-{:012}-{:012}.h5", begin, end);
}

void write_shard(const std::filesystem::path& directory, const ShardOrigin& origin, std::uint64_t begin,
                 std::span<const TrialOutcome> outcomes, double wall_s) {
  const std::filesystem::path path = directory / shard_name(begin, begin + outcomes.size());
  try {
    const hdf5::Bytes bytes = shard_bytes(origin, begin, outcomes, wall_s);
    const std::string seal = seal_of(bytes.span());
    write_whole_file(path, {bytes.span(), std::as_bytes(std::span(seal))});
  } catch (const Problem& problem) {
    throw RunFailure(fmt::format("cannot write {}: {}", path.string(), problem.what()));
  }
}

Shard read_shard(const std::filesystem::path& path, const ShardOrigin& origin, std::uint64_t trials) {
  const std::vector<std::byte> bytes = read_whole_file(path);
  try {
    const auto content = without_seal(bytes);
    if (!content) throw Problem("it is damaged: its last line is not the SHA-256 of what comes before");
    return read_bytes(*content, origin, trials);
  } catch (const Problem& problem) {
    throw RunFailure(fmt::format("cannot read {}: {}", path.string(), problem.what()));
  }
}

}  // namespace steerstat
