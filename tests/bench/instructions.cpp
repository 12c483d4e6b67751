#include "instructions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "trial/lockstep_runner.hpp"
#include "workload.hpp"

namespace steerstat::bench {
namespace {

/// Trials drawn beforehand, so that drawing them is not counted.
class DrawnStream final : public TrialStream {
 public:
  explicit DrawnStream(const Plan& plan) {
    for (std::uint64_t i = 0; i < plan.trials(); ++i) drawn_.push_back(plan.parameters(i));
  }

  bool next(std::uint64_t& index, TrialParameters& parameters) override {
    if (next_ == drawn_.size()) return false;
    index = next_;
    parameters = drawn_[next_++];
    return true;
  }
  void finished(std::uint64_t, const TrialOutcome& outcome) override {
    converged_ += outcome.status == Status::converged ? 1 : 0;
  }
  [[nodiscard]] std::size_t converged() const { return converged_; }

 private:
  std::vector<TrialParameters> drawn_;
  std::size_t next_{0};
  std::size_t converged_{0};
};

}  // namespace

void run_to_be_counted() {
  constexpr std::uint64_t trials = 300;
  DrawnStream stream{Plan(combined_study(trials))};
  LockstepRunner runner(IntegratorChoice{}.tolerance, InstructionSet::avx2, false);
  runner.run(stream);
  fmt::print("{} trials, {} converged, {} lane-steps\n", trials, stream.converged(),
             runner.engine().counters().lane_steps);
}

}  // namespace steerstat::bench
