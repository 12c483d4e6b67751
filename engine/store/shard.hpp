#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "study/study.hpp"
#include "study/trial_table.hpp"
#include "trial/trial.hpp"

namespace steerstat {

/// What the outcomes of trials depend on besides their index. Shards of the same origin belong together.
struct ShardOrigin {
  std::string engine_version;
  std::string trials_sha256;  ///< of the study, see trials_sha256()
  friend bool operator==(const ShardOrigin&, const ShardOrigin&) = default;
};

/// The origin of shards that this program makes.
ShardOrigin origin_of(const Study& study);

/// Finished trials of a study: consecutive ones, in a file of their own that never changes.
struct Shard {
  std::uint64_t begin{0};              ///< index of the first
  std::vector<TrialOutcome> outcomes;  ///< (trials) at least one
  double wall_s{0.0};                  ///< [s] that the run took for them
};

/// Its trials, with their indices.
FinishedTrials finished_trials(Shard shard);

/// "trials-000000000000-000000065536.h5" for the trials [0, 65536): in the order of names, shards are in that of
/// trials.
std::string shard_name(std::uint64_t begin, std::uint64_t end);

/// Writes a shard (schemas/result_file.md) into a directory, whole or not at all. Once this returns it is on the disk.
/// @throws RunFailure
void write_shard(const std::filesystem::path& directory, const ShardOrigin& origin, std::uint64_t begin,
                 std::span<const TrialOutcome> outcomes, double wall_s);

/// Reads a shard and checks all of it.
/// @throws RunFailure where it is damaged, of another origin, or beyond the last of `trials` trials
Shard read_shard(const std::filesystem::path& path, const ShardOrigin& origin, std::uint64_t trials);

}  // namespace steerstat
