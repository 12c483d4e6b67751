#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "core/instruction_set.hpp"
#include "study/run.hpp"
#include "study/study.hpp"
#include "study/trial_table.hpp"

namespace steerstat {

/// The shards of a study, put together.
struct JoinedShares {
  Study study;
  FinishedTrials finished;             ///< all that the study is due; the time is the sum of theirs
  unsigned threads{0};                 ///< the most that any shard ran on
  std::optional<InstructionSet> simd;  ///< the least that any shard ran on
};

/// Reads the results of a study's shards, in any order. One file at a time is open and in memory, so that beside the
/// trials themselves many shards take no more than few.
///
/// Of a study that stops on precision, shards beyond the look that stops it may be missing or unfinished: their trials
/// would be dropped anyway.
///
/// @param files  at least one
/// @throws BadUsage naming all that keeps them from being one study: shards of another study, of another engine version
///         or of another division, a shard that is there twice, missing and unfinished ones; RunFailure where a file
///         cannot be read
JoinedShares join_shares(std::span<const std::filesystem::path> files);

}  // namespace steerstat
