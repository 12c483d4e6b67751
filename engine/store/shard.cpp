#include "store/shard.hpp"

#include <fmt/format.h>

#include <numeric>
#include <optional>
#include <utility>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "store/column.hpp"
#include "store/memory_file.hpp"
#include "store/part_header.hpp"
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
  hdf5::write_part_header(file.id(), origin, wall_s);
  {
    const hdf5::Handle trials = hdf5::create_group(file.id(), "trials");
    std::vector<std::uint64_t> index(outcomes.size());
    std::iota(index.begin(), index.end(), begin);
    hdf5::write_column<std::uint64_t>(trials.id(), "index", index, "1");
    hdf5::write_outcomes(trials.id(), outcomes);
  }
  return file.close();
}

Shard read_bytes(std::span<const std::byte> bytes, const ShardOrigin& origin, std::uint64_t trials) {
  const hdf5::Session session;
  const hdf5::Handle file = hdf5::open_in_memory(bytes);
  Shard shard;
  shard.wall_s = hdf5::read_part_header(file.id(), origin);
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

FinishedTrials finished_trials(Shard shard) {
  FinishedTrials finished{{{}, std::move(shard.outcomes)}, shard.wall_s};
  for (std::uint64_t i = 0; i < finished.trials.outcomes.size(); ++i) finished.trials.index.push_back(shard.begin + i);
  return finished;
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
