#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/status.hpp"
#include "statistics/moments.hpp"
#include "statistics/quantile_sketch.hpp"
#include "study/for_each.hpp"
#include "study/trial_range.hpp"
#include "trial/metric.hpp"
#include "trial/trial.hpp"

namespace steerstat {

/// What the values of a metric say.
struct MetricSketch {
  Moments moments;
  QuantileSketch quantiles;

  void add(double value) {
    moments.add(value);
    quantiles.add(value);
  }
  void add(const MetricSketch& other) {
    moments.add(other.moments);
    quantiles.add(other.quantiles);
  }
  friend bool operator==(const MetricSketch&, const MetricSketch&) = default;
};

/// What finished trials of a study say, without their rows: how many ended how, and of every metric exact moments and
/// order statistics to QuantileSketch::relative_error. What it takes does not grow with the trials. Sketches of parts
/// add up to that of the whole, to the bit, whatever the parts. Not thread-safe.
class TrialSketch {
 public:
  struct Cell {
    std::array<std::uint64_t, status_names.size()> outcomes{};  ///< by Status
    std::array<MetricSketch, metric_count> metrics{};           ///< in the order of metrics()
    friend bool operator==(const Cell&, const Cell&) = default;
  };

  explicit TrialSketch(std::uint64_t cells = 1) : cells_(cells) {}

  /// Takes trials of consecutive indices, whole draws of them.
  ///
  /// @param begin     index of the first, where a draw begins
  /// @param outcomes  (trials) not in the sketch yet
  /// @throws std::invalid_argument for others
  void add(std::uint64_t begin, std::span<const TrialOutcome> outcomes, const ForEach& for_each);

  /// Takes the trials of another sketch of the same study, which has none that are in this one.
  /// @throws std::invalid_argument for another
  void add(const TrialSketch& other);

  /// Trials taken, ascending, none touching the next.
  [[nodiscard]] const std::vector<TrialRange>& trials() const { return trials_; }
  [[nodiscard]] std::uint64_t count() const { return trials_in(trials_); }
  [[nodiscard]] const std::vector<Cell>& cells() const { return cells_; }

  /// Over all draws, the squares of how many of a draw's trials ended so.
  [[nodiscard]] const std::array<std::uint64_t, status_names.size()>& squares() const { return squares_; }

  /// What was stored. @throws std::invalid_argument where the parts do not go together
  static TrialSketch of(const std::vector<TrialRange>& trials, std::vector<Cell> cells,
                        const std::array<std::uint64_t, status_names.size()>& squares);

  friend bool operator==(const TrialSketch&, const TrialSketch&) = default;

 private:
  void include(TrialRange range);

  std::vector<TrialRange> trials_;
  std::vector<Cell> cells_;
  std::array<std::uint64_t, status_names.size()> squares_{};
};

/// Whether two sketches have no trial in common.
bool apart(const TrialSketch& a, const TrialSketch& b);

/// Whether `a` has every trial that `b` has.
bool includes(const TrialSketch& a, const TrialSketch& b);

}  // namespace steerstat
