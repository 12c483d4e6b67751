#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "study/trial_range.hpp"

namespace steerstat {

/// How much a rank is given at a time.
struct RangeSize {
  double seconds{2.0};                                ///< of its work, as far as its rate is known; > 0
  std::uint64_t most_trials{std::uint64_t{1} << 18};  ///< whatever its rate; > 0
};

/// Deals out the trials of a study that are missing, in rising order: ranges of whole blocks, as long as a rank takes
/// some seconds for, but shorter towards the end, so that all ranks end together.
class RangeDealer {
 public:
  /// @param known  trials that need not run, ascending; those in a block with others that must run are dealt again
  /// @param ranks  > 0
  RangeDealer(std::span<const TrialRange> known, std::uint64_t trials, std::uint64_t block, unsigned ranks,
              const RangeSize& size = {});

  /// The next range for a rank; nothing once all are dealt, or after halt().
  ///
  /// @param threads  that the rank runs trials on, > 0
  /// @param rate     [1/s] trials of the rank, as far as is known; else 0
  std::optional<TrialRange> deal(unsigned threads, double rate);

  /// Deals no more.
  void halt() { dealt_ = ranges_.size(); }

  /// Trials that were not dealt.
  [[nodiscard]] std::uint64_t left() const { return trials_in(std::span(ranges_).subspan(dealt_)); }

 private:
  std::uint64_t block_;
  unsigned ranks_;
  RangeSize size_;
  std::vector<TrialRange> ranges_;  // of whole blocks, disjoint, ascending; those dealt are at the front
  std::size_t dealt_{0};
};

}  // namespace steerstat
