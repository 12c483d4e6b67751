#include "view/thinning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace steerstat {
namespace {

/// The points between two that are kept.
struct Gap {
  std::size_t first, last;  // kept
  std::size_t farthest;     // of those between
  double deviation;

  bool operator<(const Gap& other) const {
    return deviation != other.deviation ? deviation < other.deviation : first > other.first;
  }
};

class Curves {
 public:
  Curves(std::span<const double> t, std::span<const std::vector<double>> columns) : t_(t), columns_(columns) {
    for (const std::vector<double>& column : columns) {
      double low = std::numeric_limits<double>::infinity();
      double high = -low;
      for (const double y : column) {
        if (!std::isfinite(y)) continue;
        low = std::min(low, y);
        high = std::max(high, y);
      }
      scales_.push_back(high > low ? 1.0 / (high - low) : 0.0);
    }
  }

  [[nodiscard]] Gap gap(std::size_t first, std::size_t last) const {
    Gap gap{first, last, first, -1.0};
    for (std::size_t i = first + 1; i < last; ++i) {
      const double deviation = deviation_of(i, first, last);
      if (deviation <= gap.deviation) continue;
      gap.deviation = deviation;
      gap.farthest = i;
    }
    return gap;
  }

 private:
  [[nodiscard]] double deviation_of(std::size_t i, std::size_t first, std::size_t last) const {
    const double span = t_[last] - t_[first];
    const double share = span > 0.0 ? (t_[i] - t_[first]) / span : 0.0;
    double farthest = 0.0;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const std::vector<double>& y = columns_[c];
      const double line = y[first] + share * (y[last] - y[first]);
      const double deviation = std::abs(y[i] - line) * scales_[c];
      if (std::isfinite(deviation)) farthest = std::max(farthest, deviation);
    }
    return farthest;
  }

  std::span<const double> t_;
  std::span<const std::vector<double>> columns_;
  std::vector<double> scales_;  // (columns) 1 / range
};

}  // namespace

Thinned thin(std::span<const double> t, std::span<const std::vector<double>> columns,
             std::span<const std::size_t> fixed, std::size_t most) {
  const Curves curves(t, columns);
  Thinned thinned;
  thinned.kept.assign(fixed.begin(), fixed.end());
  std::priority_queue<Gap> gaps;
  const auto open = [&](std::size_t first, std::size_t last) {
    if (last > first + 1) gaps.push(curves.gap(first, last));
  };
  for (std::size_t k = 1; k < fixed.size(); ++k) open(fixed[k - 1], fixed[k]);
  while (!gaps.empty() && thinned.kept.size() < most) {
    const Gap gap = gaps.top();
    gaps.pop();
    thinned.kept.push_back(gap.farthest);
    open(gap.first, gap.farthest);
    open(gap.farthest, gap.last);
  }
  if (!gaps.empty()) thinned.largest_deviation = std::max(0.0, gaps.top().deviation);
  std::sort(thinned.kept.begin(), thinned.kept.end());
  return thinned;
}

}  // namespace steerstat
