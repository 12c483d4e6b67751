#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "study/plan.hpp"
#include "study/precision_watch.hpp"
#include "study/run.hpp"
#include "study/trial_table.hpp"

namespace steerstat {

/// Shows a study's rule the trials that ranks finish, in any order, in the order of their indices.
class PrefixWatch {
 public:
  /// @param earlier  shown too; must outlive this
  PrefixWatch(const Study& study, const TrialTable& earlier) : earlier_(earlier) {
    if (study.stop) watch_.emplace(*study.stop, study.sampling.trials, Plan(study).cells());
    advance();
  }

  /// Whether there is a rule that has seen enough.
  [[nodiscard]] bool stopped() const { return watch_ && watch_->stopped(); }

  /// Takes the trials from `begin` on.
  void add(std::uint64_t begin, std::vector<TrialOutcome> outcomes) {
    if (!watch_ || outcomes.empty()) return;
    waiting_.emplace(begin, std::move(outcomes));
    advance();
  }

 private:
  void advance() {
    while (watch_ && !watch_->stopped() && (add_earlier() || add_waiting())) {
    }
  }

  bool add_earlier() {
    while (row_ < earlier_.index.size() && earlier_.index[row_] < next_) ++row_;
    if (row_ == earlier_.index.size() || earlier_.index[row_] != next_) return false;
    watch_->add(earlier_.outcomes[row_]);
    ++next_;
    return true;
  }

  /// Adds all of the piece that the next trial is in.
  bool add_waiting() {
    if (waiting_.empty() || waiting_.begin()->first > next_) return false;
    const auto& [begin, outcomes] = *waiting_.begin();
    for (; next_ - begin < outcomes.size(); ++next_) watch_->add(outcomes[next_ - begin]);
    waiting_.erase(waiting_.begin());
    return true;
  }

  const TrialTable& earlier_;
  std::optional<PrecisionWatch> watch_;
  std::map<std::uint64_t, std::vector<TrialOutcome>> waiting_;  // by the first trial's index
  std::uint64_t next_{0};                                       // the first trial that was not shown
  std::size_t row_{0};                                          // rows of earlier_ before it were shown
};

}  // namespace steerstat
