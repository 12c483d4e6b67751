#include "store/sketched_part.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "core/errors.hpp"
#include "store/column.hpp"
#include "store/memory_file.hpp"
#include "store/part_header.hpp"
#include "store/seal.hpp"
#include "store/sketch_columns.hpp"
#include "store/trial_columns.hpp"
#include "store/whole_file.hpp"
#include "study/plan.hpp"

namespace steerstat {
namespace {

using hdf5::Problem;

hdf5::Bytes part_bytes(const ShardOrigin& origin, const FinishedTrials& piece) {
  const hdf5::Session session;
  hdf5::MemoryFile file;
  hdf5::write_part_header(file.id(), origin, piece.wall_s);
  hdf5::write_sketch(file.id(), piece.sketch.value());
  {
    const hdf5::Handle trials = hdf5::create_group(file.id(), "trials");
    hdf5::write_column<std::uint64_t>(trials.id(), "index", piece.trials.index, "1");
    hdf5::write_outcomes(trials.id(), piece.trials.outcomes);
  }
  return file.close();
}

FinishedTrials read_bytes(std::span<const std::byte> bytes, const ShardOrigin& origin, const Study& study) {
  const auto content = without_seal(bytes);
  if (!content) throw Problem("it is damaged: its last line is not the SHA-256 of what comes before");
  const hdf5::Session session;
  const hdf5::Handle file = hdf5::open_in_memory(*content);
  FinishedTrials piece;
  piece.wall_s = hdf5::read_part_header(file.id(), origin);
  const Plan plan(study);
  piece.sketch = hdf5::read_sketch(file.id(), plan.cells(), plan.trials());
  if (piece.count() == 0) throw Problem("it has no trials");
  const hdf5::Handle group = hdf5::open_group(file.id(), "trials");
  piece.trials.index = hdf5::read_index(group.id(), plan.trials());
  piece.trials.outcomes = hdf5::read_outcomes(group.id(), {0, piece.trials.index.size(), piece.trials.index.size()});
  return piece;
}

}  // namespace

void write_sketched_part(const std::filesystem::path& directory, const ShardOrigin& origin,
                         const FinishedTrials& piece) {
  const std::vector<TrialRange> ranges = piece.ranges();
  const std::filesystem::path path = directory / shard_name(ranges.front().begin, ranges.back().end);
  try {
    const hdf5::Bytes bytes = part_bytes(origin, piece);
    const std::string seal = seal_of(bytes.span());
    write_whole_file(path, {bytes.span(), std::as_bytes(std::span(seal))});
  } catch (const Problem& problem) {
    throw RunFailure(fmt::format("cannot write {}: {}", path.string(), problem.what()));
  }
}

FinishedTrials read_sketched_part(const std::filesystem::path& path, const ShardOrigin& origin, const Study& study) {
  const std::vector<std::byte> bytes = read_whole_file(path);
  try {
    return read_bytes(bytes, origin, study);
  } catch (const Problem& problem) {
    throw RunFailure(fmt::format("cannot read {}: {}", path.string(), problem.what()));
  }
}

std::vector<std::byte> sketched_part_bytes(const ShardOrigin& origin, const FinishedTrials& piece) {
  try {
    const hdf5::Bytes bytes = part_bytes(origin, piece);
    const std::string seal = seal_of(bytes.span());
    std::vector<std::byte> all(bytes.span().begin(), bytes.span().end());
    const auto sealing = std::as_bytes(std::span(seal));
    all.insert(all.end(), sealing.begin(), sealing.end());
    return all;
  } catch (const Problem& problem) {
    throw RunFailure(fmt::format("cannot send finished trials: {}", problem.what()));
  }
}

FinishedTrials sketched_part_of(std::span<const std::byte> bytes, const ShardOrigin& origin, const Study& study) {
  try {
    return read_bytes(bytes, origin, study);
  } catch (const Problem& problem) {
    throw RunFailure(fmt::format("cannot take finished trials from a rank: {}", problem.what()));
  }
}

}  // namespace steerstat
