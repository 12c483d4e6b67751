#include "study/trial_sketch.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace steerstat {
namespace {

/// Trials that are in both, however often.
std::uint64_t common(std::span<const TrialRange> a, std::span<const TrialRange> b) {
  std::uint64_t trials = 0;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    const std::uint64_t begin = std::max(a[i].begin, b[j].begin);
    const std::uint64_t end = std::min(a[i].end, b[j].end);
    if (begin < end) trials += end - begin;
    if (a[i].end < b[j].end) {
      ++i;
    } else {
      ++j;
    }
  }
  return trials;
}

}  // namespace

void TrialSketch::add(std::uint64_t begin, std::span<const TrialOutcome> outcomes, const ForEach& for_each) {
  const std::uint64_t cells = cells_.size();
  if (outcomes.empty()) return;
  const TrialRange range{begin, begin + outcomes.size()};
  if (begin % cells != 0 || outcomes.size() % cells != 0) {
    throw std::invalid_argument("TrialSketch: takes whole draws");
  }
  include(range);
  // Whatever is written by one of these, no other touches: a metric in a cell, or the counts.
  const auto sketch_metric = [&](std::size_t cell, std::size_t metric) {
    MetricSketch& sketch = cells_[cell].metrics[metric];
    const auto value_of = metrics()[metric].value;
    for (std::size_t i = cell; i < outcomes.size(); i += cells) {
      if (const double value = value_of(outcomes[i]); !std::isnan(value)) sketch.add(value);
    }
  };
  const auto count_outcomes = [&] {
    for (std::size_t draw = 0; draw < outcomes.size(); draw += cells) {
      std::array<std::uint64_t, status_names.size()> in_draw{};
      for (std::size_t cell = 0; cell < cells; ++cell) {
        const auto status = static_cast<std::size_t>(outcomes[draw + cell].status);
        ++in_draw[status];
        ++cells_[cell].outcomes[status];
      }
      for (std::size_t status = 0; status < in_draw.size(); ++status) {
        squares_[status] += in_draw[status] * in_draw[status];
      }
    }
  };
  for_each(cells * metric_count + 1, [&](std::size_t task) {
    if (task == 0) return count_outcomes();
    sketch_metric((task - 1) / metric_count, (task - 1) % metric_count);
  });
}

void TrialSketch::add(const TrialSketch& other) {
  if (other.cells_.size() != cells_.size()) throw std::invalid_argument("TrialSketch: of a study with other cells");
  for (const TrialRange& range : other.trials_) include(range);
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    const Cell& added = other.cells_[cell];
    for (std::size_t i = 0; i < added.outcomes.size(); ++i) cells_[cell].outcomes[i] += added.outcomes[i];
    for (std::size_t i = 0; i < metric_count; ++i) cells_[cell].metrics[i].add(added.metrics[i]);
  }
  for (std::size_t i = 0; i < squares_.size(); ++i) squares_[i] += other.squares_[i];
}

TrialSketch TrialSketch::of(const std::vector<TrialRange>& trials, std::vector<Cell> cells,
                            const std::array<std::uint64_t, status_names.size()>& squares) {
  TrialSketch sketch(0);
  sketch.cells_ = std::move(cells);
  for (const TrialRange& range : trials) {
    if (range.begin >= range.end || range.begin % sketch.cells_.size() != 0 || range.end % sketch.cells_.size() != 0) {
      throw std::invalid_argument("a range of trials is not one of whole draws");
    }
    sketch.include(range);
  }
  sketch.squares_ = squares;
  for (const Cell& cell : sketch.cells_) {
    std::uint64_t count = 0;
    for (const std::uint64_t outcome : cell.outcomes) count += outcome;
    if (count != sketch.count() / sketch.cells_.size()) {
      throw std::invalid_argument("the outcomes of a cell are not as many as its trials");
    }
  }
  return sketch;
}

void TrialSketch::include(TrialRange range) {
  const std::array<TrialRange, 1> added{range};
  if (common(trials_, added) > 0) throw std::invalid_argument("TrialSketch: it has some of these trials already");
  const auto later = std::find_if(trials_.begin(), trials_.end(), [&](TrialRange r) { return r.begin >= range.end; });
  auto place = trials_.insert(later, range);
  if (const auto next = place + 1; next != trials_.end() && next->begin == place->end) {
    place->end = next->end;
    trials_.erase(next);
  }
  if (place != trials_.begin() && (place - 1)->end == place->begin) {
    (place - 1)->end = place->end;
    trials_.erase(place);
  }
}

bool apart(const TrialSketch& a, const TrialSketch& b) {
  return common(a.trials(), b.trials()) == 0;
}

bool includes(const TrialSketch& a, const TrialSketch& b) {
  return common(a.trials(), b.trials()) == b.count();
}

}  // namespace steerstat
