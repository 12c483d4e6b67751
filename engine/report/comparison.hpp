#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "report/pairing.hpp"
#include "statistics/paired.hpp"
#include "statistics/sample.hpp"
#include "statistics/sample_interval.hpp"
#include "study/plan.hpp"

namespace steerstat {

/// Level of a comparison's confidence intervals.
inline constexpr double comparison_level = 0.95;

/// A comparison carries the indices of at most this many discordant trials, each way.
inline constexpr std::size_t most_discordant_indices = 100'000;

/// Settling times of B less those of A [s], over the pairs in which both converged.
struct SettlingTimeDifference {
  std::uint64_t pairs{0};
  SampleStatistics sample;
  SampleInterval mean;    ///< Student's; unbounded with fewer than two pairs, and where pairs share their draws
  SampleInterval median;  ///< between order statistics; likewise
};

/// What a set of pairs says. Pairs of several cells share their draws and are not independent: over all of them there
/// is neither a test nor an interval.
struct PairedStatistics {
  PairedCounts counts;  ///< success is convergence
  std::optional<DifferenceInterval> success_rate_difference;
  std::optional<McNemarTest> test;
  std::optional<double> holm_p_value;  ///< of the exact p-value among all cells'; cells only
  std::optional<SettlingTimeDifference> settling_time_difference;  ///< nothing where no pair has both converged
};

/// Trials that converged on one side alone.
struct DiscordantTrials {
  std::uint64_t count{0};
  std::vector<std::uint64_t> indices;  ///< ascending, the first most_discordant_indices of them
};

/// Two studies compared trial by trial, on the same draws.
struct Comparison {
  /// One of the two.
  struct Side {
    std::string id, name, spec_sha256, engine_version;
    bool complete{false};
    std::uint64_t requested{0};
    std::uint64_t completed{0};
  };
  Side a, b;
  std::vector<std::string> warnings;        ///< what a reader should know before believing it
  std::vector<SpecDifference> differences;  ///< in the specs
  std::vector<std::string> drawn;           ///< inputs that were drawn alike
  PairedStatistics all;
  struct Cell {
    std::vector<Plan::SweptValue> sweep;
    PairedStatistics statistics;
  };
  std::vector<Cell> cells;  ///< one a cell where there are several
  DiscordantTrials a_only, b_only;
};

/// Compares two studies whose trials are of the same draws: differences are of B less A. Pure and thread-safe.
///
/// @throws StudiesDoNotPair where they are not, with every reason
Comparison compare(const ComparedStudy& a, const ComparedStudy& b);

/// The comparison as JSON (schemas/comparison.schema.json), indented, ending in a newline. Every key is always there;
/// statistics without data are null.
std::string comparison_json(const Comparison& comparison);

/// The comparison as text for a terminal: UTF-8, about 100 columns, ending in a newline.
///
/// @param file_a, file_b  the result files' names, for the commands that replay discordant trials
/// @param most_listed     list at most this many discordant trials each way
/// @param colour          use ANSI colours
std::string comparison_text(const Comparison& comparison, const std::string& file_a, const std::string& file_b,
                            std::uint64_t most_listed, bool colour);

}  // namespace steerstat
