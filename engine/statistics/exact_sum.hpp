#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace steerstat {

/// A sum that rounds once, at the end: the double nearest to the true sum of what was added, whatever the order.
///
/// Keeps the running sum as doubles that do not overlap [Shewchuk 1997]; there are only a few of them unless the
/// magnitudes differ wildly. The terms must be finite and their sums must not overflow.
class ExactSum {
 public:
  void add(double term) {
    std::size_t kept = 0;
    for (double part : parts_) {
      if (std::abs(term) < std::abs(part)) {
        const double larger = part;
        part = term;
        term = larger;
      }
      const double sum = term + part;
      const double lost = part - (sum - term);  // exact, as |term| >= |part|
      if (lost != 0.0) parts_[kept++] = lost;
      term = sum;
    }
    parts_.resize(kept);
    parts_.push_back(term);
  }

  /// @return the sum of all terms, rounded to nearest, ties to even.
  [[nodiscard]] double value() const {
    if (parts_.empty()) return 0.0;
    std::size_t i = parts_.size() - 1;
    double sum = parts_[i];
    double lost = 0.0;
    while (i > 0 && lost == 0.0) {
      const double larger = sum;
      const double part = parts_[--i];
      sum = larger + part;
      lost = part - (sum - larger);
    }
    // Half a unit was lost exactly: the next part down says to which side the true sum lies.
    if (i > 0 && ((lost < 0.0) == (parts_[i - 1] < 0.0)) && parts_[i - 1] != 0.0) {
      const double doubled = 2.0 * lost;
      const double moved = sum + doubled;
      if (moved - sum == doubled) sum = moved;
    }
    return sum;
  }

 private:
  std::vector<double> parts_;  // by increasing magnitude
};

}  // namespace steerstat
