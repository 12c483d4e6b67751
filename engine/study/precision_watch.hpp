#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "core/status.hpp"
#include "study/stop_rule.hpp"
#include "trial/metric.hpp"
#include "trial/trial.hpp"

namespace steerstat {

enum class StopReason : std::uint8_t { precision_reached, max_trials };
inline constexpr std::array<std::string_view, 2> stop_reason_names{"precision_reached", "max_trials"};

/// Where a goal stands: its estimate and interval in the cell that is farthest from it.
struct GoalProgress {
  std::uint64_t cell{0};
  std::optional<double> estimate, low, high;  ///< empty where the trials do not give one yet
  bool reached{false};                        ///< in every cell
};

/// What looking at a study's trials has led to.
struct StopReport {
  std::uint64_t trials{0};           ///< of all cells, looked at: those with indices below this
  std::uint64_t looks{0};            ///< so far
  std::optional<StopReason> reason;  ///< why the study ends at `trials`; nothing while it goes on
  std::vector<GoalProgress> goals;   ///< one for each of the rule's
};

/// Follows a study's trials in the order of their indices until its rule stops it. Not thread-safe.
///
/// A quantile is that of the trials that have the metric, such as the settling time of those that converged: in the
/// order of their indices, these are independent draws from the distribution given that a trial has it.
class PrecisionWatch {
 public:
  /// @param most_draws  a cell, >= rule.min_trials
  PrecisionWatch(StopRule rule, std::uint64_t most_draws, std::uint64_t cells);

  /// Takes the outcome of the next trial, and looks where a look is due. Nothing once stopped.
  void add(const TrialOutcome& outcome);

  /// Takes all trials up to a count, which have not stopped the rule before the last of them, by how they ended. A look
  /// that is due after the last is made.
  ///
  /// @param cells   (cells) each with its `outcomes`, by Status
  /// @param trials  whole draws
  /// @pre none was taken before, and the rule asks for no quantile
  template <class Cells>
  void skip_to(const Cells& cells, std::uint64_t trials) {
    for (std::size_t cell = 0; cell < cells_.size(); ++cell) cells_[cell].outcomes = cells[cell].outcomes;
    trials_ = trials;
    while (next_look_ * cells_.size() < trials_ && next_look_ < most_draws_) {
      ++looks_;
      next_look_ = std::min(next_look_ + rule_.check_every, most_draws_);
    }
    look_where_due();
  }

  [[nodiscard]] bool stopped() const { return reason_.has_value(); }

  /// Where the study stands with the trials taken so far. Not const: finding an order statistic reorders a sample.
  [[nodiscard]] StopReport report();

 private:
  struct Cell {
    std::array<std::uint64_t, status_names.size()> outcomes{};
    std::vector<std::vector<double>> samples;  // of sampled_, in any order
  };

  [[nodiscard]] GoalProgress progress_in(std::uint64_t cell, const PrecisionGoal& goal);
  [[nodiscard]] bool all_reached();
  void look_where_due();

  const StopRule rule_;
  const std::uint64_t most_draws_;
  std::vector<std::size_t> sampled_;  // metrics that goals ask quantiles of, by metric_index
  std::vector<Cell> cells_;
  std::uint64_t trials_{0};
  std::uint64_t next_look_;  // in draws
  std::uint64_t looks_{0};
  std::optional<StopReason> reason_;
};

}  // namespace steerstat
