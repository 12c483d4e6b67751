#pragma once

#include <optional>
#include <string>

#include "distributed/lead.hpp"
#include "distributed/ranks.hpp"
#include "study/share.hpp"
#include "study_report.hpp"

namespace steerstat {

/// What the command line asks of `steerstat run`.
struct RunRequest {
  std::string spec;
  std::optional<std::string> result;  ///< without it the trials are not kept
  StudyReport report;
  unsigned threads{0};
  std::optional<std::string> simd;   ///< without it the best that this machine runs
  std::optional<std::string> shard;  ///< I/N; without it the whole study
  bool no_progress{false};
  bool resume{false};
  Sharing sharing;
};

/// @throws BadUsage for files that cannot be written, or that clash with one another or with what is read
void check_outputs(const RunRequest& request);

/// @throws BadUsage for what is no share, and for what only a whole study has
std::optional<StudyShare> share_of(const RunRequest& request);

/// @param ranks  null where this process is alone
/// @throws BadUsage for a study that has to see its trials in order, where they run in several places
void require_together(const Study& study, const RunRequest& request, const Ranks* ranks);

/// @throws BadUsage where the baseline cannot be read, or is of another population
std::optional<Baseline> read_baseline(const RunRequest& request, const Study& study);

}  // namespace steerstat
