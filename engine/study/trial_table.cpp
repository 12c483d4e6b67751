#include "study/trial_table.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace steerstat {
namespace {

/// Appends trials that all come later than those in `a`.
FinishedTrials appended(FinishedTrials a, const FinishedTrials& b) {
  a.trials.index.insert(a.trials.index.end(), b.trials.index.begin(), b.trials.index.end());
  a.trials.outcomes.insert(a.trials.outcomes.end(), b.trials.outcomes.begin(), b.trials.outcomes.end());
  a.wall_s += b.wall_s;
  return a;
}

/// Rows of both by index; of a trial that both have, the one of `a`.
FinishedTrials interleaved(const FinishedTrials& a, const FinishedTrials& b) {
  FinishedTrials both;
  std::size_t row_a = 0;
  std::size_t row_b = 0;
  const auto take = [&both](const TrialTable& table, std::size_t row) {
    both.trials.index.push_back(table.index[row]);
    both.trials.outcomes.push_back(table.outcomes[row]);
  };
  while (row_a < a.trials.index.size() || row_b < b.trials.index.size()) {
    if (row_b == b.trials.index.size()) {
      take(a.trials, row_a++);
    } else if (row_a == a.trials.index.size() || b.trials.index[row_b] < a.trials.index[row_a]) {
      take(b.trials, row_b++);
    } else {
      if (a.trials.index[row_a] == b.trials.index[row_b]) ++row_b;
      take(a.trials, row_a++);
    }
  }
  // Where one holds all that the other does, it was made of the other, whose time it counts already.
  const bool each_adds = both.trials.index.size() > std::max(a.trials.index.size(), b.trials.index.size());
  both.wall_s = each_adds ? a.wall_s + b.wall_s : std::max(a.wall_s, b.wall_s);
  return both;
}

FinishedTrials sketches_joined(FinishedTrials a, FinishedTrials b) {
  if (!a.sketch || !b.sketch) return a.sketch ? a : b;
  if (a.count() < b.count()) std::swap(a, b);
  if (includes(*a.sketch, *b.sketch) || !apart(*a.sketch, *b.sketch)) return a;
  TrialSketch sketch = *std::exchange(a.sketch, {});
  sketch.add(*std::exchange(b.sketch, {}));
  const double wall_s = a.wall_s + b.wall_s;
  FinishedTrials both = joined(std::move(a), std::move(b));
  both.wall_s = wall_s;
  both.sketch = std::move(sketch);
  return both;
}

}  // namespace

FinishedTrials joined(FinishedTrials a, FinishedTrials b) {
  if (a.sketch || b.sketch) return sketches_joined(std::move(a), std::move(b));
  if (b.trials.index.empty()) return a;
  if (a.trials.index.empty()) return b;
  if (a.trials.index.back() < b.trials.index.front()) return appended(std::move(a), b);
  return interleaved(a, b);
}

FinishedTrials counted_from(TrialRange range, FinishedTrials finished) {
  std::vector<std::uint64_t>& index = finished.trials.index;
  std::vector<TrialOutcome>& outcomes = finished.trials.outcomes;
  const auto first = std::lower_bound(index.begin(), index.end(), range.begin) - index.begin();
  const auto last = std::lower_bound(index.begin(), index.end(), range.end) - index.begin();
  index.erase(index.begin() + last, index.end());
  index.erase(index.begin(), index.begin() + first);
  outcomes.erase(outcomes.begin() + last, outcomes.end());
  outcomes.erase(outcomes.begin(), outcomes.begin() + first);
  for (std::uint64_t& trial : index) trial -= range.begin;
  return finished;
}

std::vector<TrialOutcome> spread(TrialTable table, std::uint64_t trials) {
  if (!table.index.empty() && table.index.back() >= trials) {
    throw std::invalid_argument("spread: a trial beyond the last of the study");
  }
  const std::size_t rows = table.index.size();
  std::vector<TrialOutcome> slots = std::move(table.outcomes);
  slots.resize(trials);
  // From the last row down: no index is below its row, so nothing is overwritten that has not moved yet.
  for (std::size_t row = rows; row-- > 0;) {
    if (table.index[row] != row) slots[table.index[row]] = std::exchange(slots[row], {});
  }
  return slots;
}

TrialTable gathered(std::vector<TrialOutcome> slots, std::uint64_t end, std::span<const TrialRange> known) {
  TrialTable table;
  table.index.resize(end);
  std::iota(table.index.begin(), table.index.end(), std::uint64_t{0});
  for (const TrialRange& range : known) {
    for (std::uint64_t index = std::max(range.begin, end); index < range.end; ++index) {
      slots[table.index.size()] = slots[index];
      table.index.push_back(index);
    }
  }
  slots.resize(table.index.size());
  table.outcomes = std::move(slots);
  return table;
}

}  // namespace steerstat
