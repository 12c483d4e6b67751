#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "store/shard.hpp"
#include "study/study.hpp"
#include "study/trial_table.hpp"

namespace steerstat {

/// Writes finished trials of a study that does not keep all rows into a directory, as write_shard() those of one that
/// does: their sketch, and the rows that are kept. The name goes from the first trial to the end of the last.
/// @param piece  with a sketch of at least one trial
/// @throws RunFailure
void write_sketched_part(const std::filesystem::path& directory, const ShardOrigin& origin,
                         const FinishedTrials& piece);

/// Reads what write_sketched_part() wrote, and checks all of it.
/// @throws RunFailure where it is damaged, of another origin, or not of such a study
FinishedTrials read_sketched_part(const std::filesystem::path& path, const ShardOrigin& origin, const Study& study);

/// The same as bytes, to be sent from process to process.
std::vector<std::byte> sketched_part_bytes(const ShardOrigin& origin, const FinishedTrials& piece);
FinishedTrials sketched_part_of(std::span<const std::byte> bytes, const ShardOrigin& origin, const Study& study);

}  // namespace steerstat
