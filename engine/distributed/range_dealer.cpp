#include "distributed/range_dealer.hpp"

#include <algorithm>

namespace steerstat {
namespace {

constexpr std::uint64_t first_blocks_a_thread = 4;  // while a rank's rate is not known

/// The blocks that anything is missing of, joined where they touch.
std::vector<TrialRange> ranges_missing(std::span<const TrialRange> known, std::uint64_t trials, std::uint64_t block) {
  std::vector<TrialRange> ranges;
  const auto add_gap = [&](std::uint64_t begin, std::uint64_t end) {
    if (begin >= end) return;
    const TrialRange whole{begin / block * block, std::min((end + block - 1) / block * block, trials)};
    if (!ranges.empty() && ranges.back().end >= whole.begin) {
      ranges.back().end = whole.end;
    } else {
      ranges.push_back(whole);
    }
  };
  std::uint64_t begin = 0;
  for (const TrialRange& range : known) {
    add_gap(begin, std::min(range.begin, trials));
    begin = range.end;
  }
  add_gap(begin, trials);
  return ranges;
}

}  // namespace

RangeDealer::RangeDealer(std::span<const TrialRange> known, std::uint64_t trials, std::uint64_t block, unsigned ranks,
                         const RangeSize& size)
    : block_(block), ranks_(ranks), size_(size), ranges_(ranges_missing(known, trials, block)) {}

std::optional<TrialRange> RangeDealer::deal(unsigned threads, double rate) {
  if (dealt_ == ranges_.size()) return std::nullopt;
  const std::uint64_t of_time = rate > 0.0 ? static_cast<std::uint64_t>(std::min(rate * size_.seconds, 1e15)) / block_
                                           : first_blocks_a_thread * threads;
  // Half of an even share of what is left: the last ranges are short, whoever is slow.
  const std::uint64_t fair = left() / block_ / (2 * std::uint64_t{ranks_});
  const std::uint64_t most = std::max(size_.most_trials / block_, std::uint64_t{1});
  const std::uint64_t blocks = std::clamp(std::min(of_time, fair), std::min<std::uint64_t>(threads, most), most);
  TrialRange& next = ranges_[dealt_];
  const TrialRange range{next.begin, std::min(next.begin + blocks * block_, next.end)};
  next.begin = range.end;
  if (next.begin == next.end) ++dealt_;
  return range;
}

}  // namespace steerstat
