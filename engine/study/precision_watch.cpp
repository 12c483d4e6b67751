#include "study/precision_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "statistics/confidence_sequence.hpp"
#include "study/rate.hpp"

namespace steerstat {
namespace {

std::vector<std::size_t> metrics_of(const StopRule& rule) {
  std::vector<std::size_t> indices;
  for (const PrecisionGoal& goal : rule.until) {
    if (goal.quantile) indices.push_back(metric_index(goal.metric));
  }
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  return indices;
}

/// The value at a rank, counted from 1. Reorders the sample.
double order_statistic(std::vector<double>& sample, std::uint64_t rank) {
  const auto place = sample.begin() + static_cast<std::ptrdiff_t>(rank - 1);
  std::nth_element(sample.begin(), place, sample.end());
  return *place;
}

/// The p-quantile, as quantile() of the sorted sample. Reorders the sample, which is not empty.
double quantile_of(std::vector<double>& sample, double p) {
  const double h = static_cast<double>(sample.size() - 1) * p;
  const auto below = static_cast<std::uint64_t>(h);
  const double low = order_statistic(sample, below + 1);
  if (below + 1 >= sample.size()) return low;
  return std::lerp(low, order_statistic(sample, below + 2), h - static_cast<double>(below));
}

/// Half the interval's width in the goal's measure; infinite where a bound is missing.
double half_width(const PrecisionGoal& goal, const GoalProgress& progress) {
  if (!progress.low || !progress.high) return std::numeric_limits<double>::infinity();
  const double half = (*progress.high - *progress.low) / 2.0;
  if (!goal.relative || half == 0.0) return half;
  return half / std::abs(*progress.estimate);  // infinite for an estimate of 0
}

}  // namespace

PrecisionWatch::PrecisionWatch(StopRule rule, std::uint64_t most_draws, std::uint64_t cells)
    : rule_(std::move(rule)),
      most_draws_(most_draws),
      sampled_(metrics_of(rule_)),
      cells_(cells, Cell{{}, std::vector<std::vector<double>>(sampled_.size())}),
      next_look_(std::min(rule_.min_trials, most_draws)) {}

void PrecisionWatch::add(const TrialOutcome& outcome) {
  if (stopped()) return;
  Cell& cell = cells_[trials_ % cells_.size()];
  ++cell.outcomes[static_cast<std::size_t>(outcome.status)];
  for (std::size_t i = 0; i < sampled_.size(); ++i) {
    if (const double value = metrics()[sampled_[i]].value(outcome); !std::isnan(value))
      cell.samples[i].push_back(value);
  }
  ++trials_;
  look_where_due();
}

void PrecisionWatch::look_where_due() {
  if (trials_ != next_look_ * cells_.size()) return;
  ++looks_;
  if (all_reached()) {
    reason_ = StopReason::precision_reached;
  } else if (next_look_ == most_draws_) {
    reason_ = StopReason::max_trials;
  }
  next_look_ = std::min(next_look_ + rule_.check_every, most_draws_);
}

GoalProgress PrecisionWatch::progress_in(std::uint64_t cell, const PrecisionGoal& goal) {
  GoalProgress progress{cell, {}, {}, {}, false};
  if (goal.quantile) {
    const auto found = std::lower_bound(sampled_.begin(), sampled_.end(), metric_index(goal.metric));
    std::vector<double>& sample = cells_[cell].samples[static_cast<std::size_t>(found - sampled_.begin())];
    const QuantileRanks ranks = confidence_sequence_ranks(sample.size(), *goal.quantile, rule_.level);
    if (!sample.empty()) progress.estimate = quantile_of(sample, *goal.quantile);
    if (ranks.low) progress.low = order_statistic(sample, *ranks.low);
    if (ranks.high) progress.high = order_statistic(sample, *ranks.high);
  } else {
    std::uint64_t trials = 0;
    for (const std::uint64_t count : cells_[cell].outcomes) trials += count;
    const auto outcome = static_cast<std::size_t>(outcome_of_rate(goal.metric).value());
    if (trials > 0) {
      const ProportionInterval rate = confidence_sequence(cells_[cell].outcomes[outcome], trials, rule_.level);
      progress.estimate = rate.estimate;
      progress.low = rate.low;
      progress.high = rate.high;
    }
  }
  progress.reached = half_width(goal, progress) <= goal.half_width;
  return progress;
}

bool PrecisionWatch::all_reached() {
  return std::all_of(rule_.until.begin(), rule_.until.end(), [&](const PrecisionGoal& goal) {
    for (std::uint64_t cell = 0; cell < cells_.size(); ++cell) {
      if (!progress_in(cell, goal).reached) return false;
    }
    return true;
  });
}

StopReport PrecisionWatch::report() {
  StopReport report{trials_, looks_, reason_, {}};
  for (const PrecisionGoal& goal : rule_.until) {
    GoalProgress farthest = progress_in(0, goal);
    for (std::uint64_t cell = 1; cell < cells_.size(); ++cell) {
      const GoalProgress progress = progress_in(cell, goal);
      if (half_width(goal, progress) > half_width(goal, farthest)) farthest = progress;
    }
    report.goals.push_back(farthest);
  }
  return report;
}

}  // namespace steerstat
