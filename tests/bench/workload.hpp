#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "clocks.hpp"
#include "study/plan.hpp"
#include "study/study.hpp"
#include "trial/runner.hpp"
#include "trial/trial.hpp"

namespace steerstat::bench {

/// How to make the runner of one thread.
using MakeRunner = std::function<std::unique_ptr<TrialRunner>()>;

/// studies/specs/robustness/combined.json with as many trials as asked, no retained trajectories and no audit.
Study combined_study(std::uint64_t trials);

/// Trials run, and how long they took.
struct Run {
  std::vector<TrialOutcome> outcomes;  ///< by index
  Duration duration;
};

/// Runs the combined study as the program does.
Run run_trials(std::uint64_t trials, const MakeRunner& make_runner, unsigned threads = 1);

/// Feeds the trials of a plan to a runner on this thread, and keeps their outcomes.
class PlanStream final : public TrialStream {
 public:
  explicit PlanStream(const Plan& plan) : plan_(plan), outcomes_(plan.trials()) {}

  bool next(std::uint64_t& index, TrialParameters& parameters) override {
    if (next_ == plan_.trials()) return false;
    index = next_++;
    parameters = plan_.parameters(index);
    return true;
  }
  void finished(std::uint64_t index, const TrialOutcome& outcome) override { outcomes_[index] = outcome; }

  [[nodiscard]] const std::vector<TrialOutcome>& outcomes() const { return outcomes_; }

 private:
  const Plan& plan_;
  std::vector<TrialOutcome> outcomes_;
  std::uint64_t next_{0};
};

}  // namespace steerstat::bench
