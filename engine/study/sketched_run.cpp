#include "study/sketched_run.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "core/elapsed.hpp"
#include "study/audit.hpp"
#include "study/precision_watch.hpp"
#include "study/trial_table.hpp"

namespace steerstat {
namespace {

using Clock = std::chrono::steady_clock;

bool failed(const TrialOutcome& outcome) {
  return outcome.status != Status::converged;
}

/// How many trials to run next: a second's work, whatever the machine; so few at first that a slow one is not long
/// about it, and never more than are to be in memory.
class PieceSize {
 public:
  PieceSize(const Study& study, std::uint64_t cells, unsigned threads)
      : cells_(cells), least_(block_size(study) * threads), next_(4 * least_) {}

  [[nodiscard]] std::uint64_t next() const { return whole_draws(next_); }
  [[nodiscard]] std::uint64_t largest() const { return whole_draws(std::max(most, next_)); }

  void took(std::uint64_t trials, double seconds) {
    constexpr double aim = 1.0;
    const double due = static_cast<double>(trials) * std::min(aim / std::max(seconds, 1e-6), 16.0);
    next_ = std::clamp(static_cast<std::uint64_t>(due), std::min(least_, most), most);
  }

 private:
  static constexpr std::uint64_t most = std::uint64_t{1} << 18;

  [[nodiscard]] std::uint64_t whole_draws(std::uint64_t trials) const {
    return (trials + cells_ - 1) / cells_ * cells_;
  }

  const std::uint64_t cells_;
  const std::uint64_t least_;
  std::uint64_t next_;
};

class SketchedRun {
 public:
  SketchedRun(const Study& study, const Plan& plan, TrialRange range, const RunOptions& options, FinishedTrials earlier,
              const SketchedRunMeans& means)
      : study_(study), range_(range), options_(options), means_(means), cells_(plan.cells()), all_(std::move(earlier)) {
    if (study.stop) watch_.emplace(*study.stop, study.sampling.trials, cells_);
    if (!all_.sketch || !is_usable()) all_ = {{}, all_.wall_s, TrialSketch(cells_)};
    if (watch_) watch_->skip_to(all_.sketch->cells(), all_.count());
    earlier_ = all_.count();
    earlier_s_ = all_.wall_s;
  }

  bool run(StudyResult& result) {
    pending_.sketch.emplace(cells_);
    PieceSize size(study_, cells_, result.threads);
    room_.outcomes.reserve(std::min(size.largest(), range_.end - range_.begin));
    for (const TrialRange& gap : gaps()) {
      for (std::uint64_t begin = gap.begin; begin < gap.end && !is_over();) {
        begin += run_piece({begin, std::min(begin + size.next(), gap.end)}, size);
      }
    }
    hand_over();
    const bool complete = watch_ ? watch_->stopped() : all_.count() == range_.end - range_.begin;
    result.wall_s = earlier_s_ + seconds_since(start_);
    result.trials = std::move(all_.trials);
    result.sketch = std::move(all_.sketch);
    return complete;
  }

 private:
  /// A rule sees trials in order: no sketch tells what it would have seen of trials before a gap. And of a range, those
  /// outside cannot be taken out again.
  [[nodiscard]] bool is_usable() const {
    const std::vector<TrialRange>& known = all_.sketch->trials();
    if (known.empty()) return true;
    if (watch_) return known.size() == 1 && known.front().begin == 0;
    return known.front().begin >= range_.begin && known.back().end <= range_.end;
  }

  [[nodiscard]] std::vector<TrialRange> gaps() const {
    std::vector<TrialRange> gaps;
    std::uint64_t begin = range_.begin;
    for (const TrialRange& known : all_.sketch->trials()) {
      if (begin < known.begin) gaps.push_back({begin, known.begin});
      begin = known.end;
    }
    if (begin < range_.end) gaps.push_back({begin, range_.end});
    return gaps;
  }

  [[nodiscard]] bool is_over() const {
    return interrupted_ || options_.stop.stop_requested() || (watch_ && watch_->stopped());
  }

  /// @return how many trials of it were kept
  std::uint64_t run_piece(TrialRange piece, PieceSize& size) {
    const Clock::time_point start = Clock::now();
    StudyResult ran = means_.run_piece(piece, options_of_piece(), std::exchange(room_, {}));
    std::uint64_t kept = ran.trials.outcomes.size() / cells_ * cells_;
    interrupted_ = kept < piece.end - piece.begin;
    if (watch_) kept = watched(ran.trials.outcomes, kept, piece.begin);
    const auto outcomes = std::span(ran.trials.outcomes).first(kept);
    keep_rows(piece.begin, outcomes);
    pending_.sketch->add(piece.begin, outcomes, means_.for_each);
    room_ = std::move(ran.trials);
    room_.index.clear();
    room_.outcomes.clear();
    const double seconds = seconds_since(start);
    pending_.wall_s += seconds;
    size.took(piece.end - piece.begin, seconds);
    if (is_due()) hand_over();
    return kept;
  }

  /// Shows the rule the next trials. @return how many it lets the study have
  std::uint64_t watched(std::span<const TrialOutcome> outcomes, std::uint64_t count, std::uint64_t begin) {
    for (std::uint64_t i = 0; i < count; ++i) {
      watch_->add(outcomes[i]);
      if (watch_->stopped()) return watch_->report().trials - begin;
    }
    return count;
  }

  void keep_rows(std::uint64_t begin, std::span<const TrialOutcome> outcomes) {
    std::uint64_t failures = failures_before(all_.trials, begin) + failures_before(pending_.trials, begin);
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      if (!failed(outcomes[i])) continue;
      if (study_.store == Store::summary && failures++ >= study_.retention.failed) return;
      pending_.trials.index.push_back(begin + i);
      pending_.trials.outcomes.push_back(outcomes[i]);
    }
  }

  /// Where not all failed trials are kept: how many are, of those before `begin`.
  [[nodiscard]] std::uint64_t failures_before(const TrialTable& rows, std::uint64_t begin) const {
    if (study_.store != Store::summary) return 0;
    const auto end = std::lower_bound(rows.index.begin(), rows.index.end(), begin) - rows.index.begin();
    return static_cast<std::uint64_t>(std::count_if(rows.outcomes.begin(), rows.outcomes.begin() + end, failed));
  }

  [[nodiscard]] RunOptions options_of_piece() const {
    RunOptions options = options_;
    options.sink = nullptr;
    if (!options_.on_progress) return options;
    options.on_progress = [this, before = all_.count() + pending_.count()](const Progress& progress) {
      options_.on_progress({before + progress.completed, range_.end - range_.begin, seconds_since(start_), earlier_});
    };
    return options;
  }

  [[nodiscard]] bool is_due() const {
    const double patience = std::clamp(seconds_since(start_) / 20.0, 0.1, 10.0);
    return options_.sink != nullptr && seconds_since(last_) >= patience;
  }

  void hand_over() {
    if (pending_.count() == 0) return;
    if (options_.sink != nullptr) options_.sink->take_sketched(pending_);
    all_ = joined(std::move(all_), std::move(pending_));
    pending_ = {{}, 0.0, TrialSketch(cells_)};
    last_ = Clock::now();
  }

  const Study& study_;
  const TrialRange range_;
  const RunOptions& options_;
  const SketchedRunMeans& means_;
  const std::uint64_t cells_;
  FinishedTrials all_;
  FinishedTrials pending_;  // of all, what the sink was not given yet
  TrialTable room_;         // for the rows of a piece
  std::optional<PrecisionWatch> watch_;
  std::uint64_t earlier_{0};
  double earlier_s_{0.0};
  bool interrupted_{false};
  const Clock::time_point start_{Clock::now()};
  Clock::time_point last_{start_};
};

std::set<std::uint64_t> trials_looked_at(const Study& study, const TrialSketch& sketch,
                                         const std::vector<std::uint64_t>& audited) {
  std::set<std::uint64_t> indices(audited.begin(), audited.end());
  for (const TrialRange& range : sketch.trials()) {
    for (std::uint64_t index = range.begin; index < std::min(range.end, study.retention.first); ++index) {
      indices.insert(index);
    }
  }
  return indices;
}

}  // namespace

bool run_sketched(const Study& study, const Plan& plan, TrialRange range, const RunOptions& options,
                  FinishedTrials earlier, const SketchedRunMeans& means, StudyResult& result) {
  return SketchedRun(study, plan, range, options, std::move(earlier), means).run(result);
}

std::vector<std::uint64_t> complete_rows(const Study& study, const Plan& plan, const RunOptions& options,
                                         const ForEach& for_each, StudyResult& result) {
  // Complete, it has all trials up to some index, so that a row of them is its index.
  std::vector<std::uint64_t> audited;
  if (result.complete) {
    audited = rows_to_audit(study.sampling.seed, study.audited_trials, result.sketch->count());
  }
  std::set<std::uint64_t> looked_at = trials_looked_at(study, *result.sketch, audited);
  TrialTable kept;
  std::uint64_t failures = 0;
  for (std::size_t row = 0; row < result.trials.index.size(); ++row) {
    const std::uint64_t index = result.trials.index[row];
    const TrialOutcome& outcome = result.trials.outcomes[row];
    const bool stays = failed(outcome) && (study.store == Store::failed || failures++ < study.retention.failed);
    if (!stays && !looked_at.contains(index)) continue;
    looked_at.erase(index);
    kept.index.push_back(index);
    kept.outcomes.push_back(outcome);
  }
  TrialTable again;
  again.index.assign(looked_at.begin(), looked_at.end());
  again.outcomes.resize(again.index.size());
  for_each(again.index.size(), [&](std::size_t i) {
    const auto runner =
        options.make_runner ? options.make_runner(study.integrator) : make_runner(study.integrator, options.simd);
    again.outcomes[i] = runner->run(plan.parameters(again.index[i]));
  });
  result.trials = joined({std::move(kept)}, {std::move(again)}).trials;
  return audited;
}

}  // namespace steerstat
