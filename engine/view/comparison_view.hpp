#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/status.hpp"
#include "report/comparison.hpp"
#include "view/distribution.hpp"

namespace steerstat {

/// A comparison's view has at most this many discordant trials each way.
inline constexpr std::size_t most_shown_discordant = 1'000;

/// What the page shows of two studies on the same draws (schemas/view.schema.json, `comparison`).
struct ComparisonView {
  Comparison comparison;                   ///< with at most most_shown_discordant indices each way
  EmpiricalDistribution a, b, difference;  ///< settling times [s] of the paired trials; the last one B less A
  struct SharedInput {
    std::string input;
    std::string unit;
  };
  std::vector<SharedInput> inputs;  ///< that both draw alike
  struct Discordant {
    std::vector<std::uint64_t> index;         ///< (shown) rising
    std::vector<Status> status_a, status_b;   ///< (shown)
    std::vector<double> settling_time;        ///< (shown) [s] on the side that converged
    std::vector<std::vector<double>> inputs;  ///< (inputs x shown)
  };
  Discordant discordant;
};

/// @throws StudiesDoNotPair where they are not of the same draws, with every reason
ComparisonView comparison_view(const ComparedStudy& a, const ComparedStudy& b);

/// The view as JSON (schemas/view.schema.json), ending in a newline.
std::string comparison_view_json(const ComparisonView& view);

}  // namespace steerstat
