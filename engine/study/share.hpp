#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "study/study.hpp"
#include "study/trial_range.hpp"

namespace steerstat {

/// Which part of a study's trials runs in one place: shard `number` of `count`, counted from 1 as job arrays do.
struct StudyShare {
  std::uint32_t number;
  std::uint32_t count;
  friend bool operator==(const StudyShare&, const StudyShare&) = default;
};

/// Shards that a study may be cut into at most.
inline constexpr std::uint32_t most_shares = 1'000'000;

/// Reads "I/N", as "3/10". @return nothing unless 1 <= I <= N <= most_shares
std::optional<StudyShare> parse_share(std::string_view text);

/// "3/10"
std::string share_text(const StudyShare& share);

/// The trials of a share: consecutive whole blocks, as many in each share as in any other but for one. The shares of a
/// study are disjoint, in order, and together all of its trials. Where there are fewer blocks than shares, some are
/// empty.
///
/// @param block  trials a block, > 0
TrialRange share_of(std::uint64_t trials, std::uint64_t block, const StudyShare& share);

/// The same of a study, in portions of portion_size().
TrialRange trials_of(const Study& study, const StudyShare& share);

}  // namespace steerstat
