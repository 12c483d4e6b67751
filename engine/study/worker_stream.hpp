#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

#include "study/block_queue.hpp"
#include "study/check_in.hpp"
#include "study/finished_prefix.hpp"
#include "study/handover.hpp"
#include "study/plan.hpp"
#include "study/progress_reports.hpp"
#include "study/turnstile.hpp"
#include "trial/runner.hpp"

namespace steerstat {

/// The trials of a plan from one on, counted from it.
struct PlannedTrials {
  const Plan& plan;
  TrialRange range;

  [[nodiscard]] std::uint64_t count() const { return range.end - range.begin; }
  [[nodiscard]] TrialParameters parameters(std::uint64_t index) const { return plan.parameters(range.begin + index); }
};

/// What is told of every finished trial, beside its slot.
struct Listeners {
  FinishedPrefix* prefix;  ///< null where nothing but the last trial ends the run
  HandOver* handover;      ///< null where nobody takes the outcomes meanwhile
};

/// Feeds one worker's runner block after block, so that its lanes refill across blocks, and stores each outcome in the
/// slot of its index. The slots of different trials are distinct objects: no two workers write the same one.
class WorkerStream final : public TrialStream {
 public:
  WorkerStream(const PlannedTrials& planned, BlockQueue& blocks, std::vector<TrialOutcome>& outcomes,
               Listeners listeners, Tally& tally, Turnstile::Turn& turn, const std::stop_token& give_up)
      : planned_(planned),
        blocks_(blocks),
        outcomes_(outcomes),
        listeners_(listeners),
        tally_(tally),
        turn_(turn),
        give_up_(give_up) {}

  bool next(std::uint64_t& index, TrialParameters& parameters) override {
    if (block_.begin == block_.end) {
      if (dry_) return false;
      turn_.give_way();
      const std::optional<TrialRange> claimed = blocks_.claim();
      dry_ = !claimed;
      if (dry_) return false;
      block_ = *claimed;
    }
    index = block_.begin++;
    parameters = planned_.parameters(index);
    return true;
  }

  void finished(std::uint64_t index, const TrialOutcome& outcome) override {
    outcomes_[index] = outcome;
    tally_.finished.fetch_add(1, std::memory_order_relaxed);
    if (listeners_.prefix != nullptr && listeners_.prefix->finished(index)) blocks_.halt();
    if (listeners_.handover != nullptr) listeners_.handover->finished(index);
  }

  void check_in() override { steerstat::check_in(turn_, give_up_); }

 private:
  const PlannedTrials planned_;
  BlockQueue& blocks_;
  std::vector<TrialOutcome>& outcomes_;
  const Listeners listeners_;
  Tally& tally_;
  Turnstile::Turn& turn_;
  const std::stop_token& give_up_;
  TrialRange block_{0, 0};
  bool dry_{false};  // a runner may ask again after the end; the answer stays no
};

}  // namespace steerstat
