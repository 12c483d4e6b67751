#include "study/trial_range.hpp"

#include <algorithm>
#include <numeric>

namespace steerstat {
namespace {

void cut(TrialRange gap, std::uint64_t block, std::vector<TrialRange>& pieces) {
  while (gap.begin < gap.end) {
    const std::uint64_t end = std::min(gap.end, (gap.begin / block + 1) * block);
    pieces.push_back({gap.begin, end});
    gap.begin = end;
  }
}

}  // namespace

std::vector<TrialRange> ranges_of(std::span<const std::uint64_t> index) {
  std::vector<TrialRange> ranges;
  for (const std::uint64_t trial : index) {
    if (ranges.empty() || ranges.back().end != trial) ranges.push_back({trial, trial});
    ++ranges.back().end;
  }
  return ranges;
}

std::vector<TrialRange> missing_blocks(std::span<const TrialRange> known, std::uint64_t trials, std::uint64_t block) {
  std::vector<TrialRange> pieces;
  std::uint64_t begin = 0;
  for (const TrialRange& range : known) {
    cut({begin, std::min(range.begin, trials)}, block, pieces);
    begin = range.end;
  }
  cut({begin, trials}, block, pieces);
  return pieces;
}

std::uint64_t trials_in(std::span<const TrialRange> ranges) {
  return std::accumulate(ranges.begin(), ranges.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const TrialRange& range) { return sum + (range.end - range.begin); });
}

}  // namespace steerstat
