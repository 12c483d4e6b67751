#include "trial/lockstep_router.hpp"

#include <cstddef>
#include <deque>
#include <optional>

#include "trial/course.hpp"

namespace steerstat {
namespace {

struct Waiting {
  std::uint64_t index{0};
  TrialParameters parameters{};
};

constexpr LoopKind other_than(LoopKind kind) {
  return kind == LoopKind::ideal ? LoopKind::imperfect : LoopKind::ideal;
}

/// A stream's trials, split by kind. While one runner takes those of its kind, the others wait. They are few, since
/// whoever takes a trial from the stream keeps other workers from it; in a study of one kind there are none.
class Sorter {
 public:
  explicit Sorter(TrialStream& source) : source_(source) {}

  bool next(LoopKind kind, std::uint64_t& index, TrialParameters& parameters) {
    std::deque<Waiting>& own = queue(kind);
    if (!own.empty()) {
      index = own.front().index;
      parameters = own.front().parameters;
      own.pop_front();
      return true;
    }
    std::deque<Waiting>& others = queue(other_than(kind));
    while (others.size() < most_waiting && take(index, parameters)) {
      if (loop_kind_of(parameters) == kind) return true;
      others.push_back({index, parameters});
    }
    return false;
  }

  /// The kind of a trial that waits, or would be next; nothing when there is none.
  std::optional<LoopKind> kind_of_next() {
    if (ideal_.empty() && imperfect_.empty()) {
      Waiting trial;
      if (!take(trial.index, trial.parameters)) return std::nullopt;
      queue(loop_kind_of(trial.parameters)).push_back(trial);
    }
    return ideal_.empty() ? LoopKind::imperfect : LoopKind::ideal;
  }

  void finished(std::uint64_t index, const TrialOutcome& outcome) { source_.finished(index, outcome); }
  void check_in() { source_.check_in(); }

 private:
  static constexpr std::size_t most_waiting = 128;

  bool take(std::uint64_t& index, TrialParameters& parameters) {
    dry_ = dry_ || !source_.next(index, parameters);
    return !dry_;
  }

  std::deque<Waiting>& queue(LoopKind kind) { return kind == LoopKind::ideal ? ideal_ : imperfect_; }

  TrialStream& source_;
  std::deque<Waiting> ideal_;
  std::deque<Waiting> imperfect_;
  bool dry_{false};
};

/// The trials of one kind.
class SortedStream final : public TrialStream {
 public:
  SortedStream(Sorter& sorter, LoopKind kind) : sorter_(sorter), kind_(kind) {}

  bool next(std::uint64_t& index, TrialParameters& parameters) override {
    return sorter_.next(kind_, index, parameters);
  }
  void finished(std::uint64_t index, const TrialOutcome& outcome) override { sorter_.finished(index, outcome); }
  void check_in() override { sorter_.check_in(); }

 private:
  Sorter& sorter_;
  LoopKind kind_;
};

}  // namespace

LockstepRouter::LockstepRouter(double tolerance, InstructionSet set, bool metrics)
    : tolerance_(tolerance), set_(set), metrics_(metrics), ideal_(tolerance, set, metrics) {}

void LockstepRouter::run(TrialStream& stream) {
  Sorter sorter(stream);
  while (const std::optional<LoopKind> kind = sorter.kind_of_next()) {
    SortedStream trials(sorter, *kind);
    if (*kind == LoopKind::ideal) {
      ideal_.run(trials);
    } else {
      if (!imperfect_) imperfect_ = std::make_unique<LockstepRunner>(tolerance_, set_, metrics_, LoopKind::imperfect);
      imperfect_->run(trials);
    }
  }
}

}  // namespace steerstat
