#include "trial/runner.hpp"

#include "core/errors.hpp"
#include "trial/cvode_runner.hpp"
#include "trial/lockstep_router.hpp"

namespace steerstat {
namespace {

/// One trial, and its outcome when it is done.
class SingleTrial final : public TrialStream {
 public:
  SingleTrial(const TrialParameters& parameters, const std::function<void()>& check_in)
      : parameters_(parameters), check_in_(check_in) {}

  bool next(std::uint64_t& index, TrialParameters& parameters) override {
    if (taken_) return false;
    taken_ = true;
    index = 0;
    parameters = parameters_;
    return true;
  }

  void finished(std::uint64_t, const TrialOutcome& outcome) override { outcome_ = outcome; }
  void check_in() override {
    if (check_in_) check_in_();
  }

  [[nodiscard]] const TrialOutcome& outcome() const { return outcome_; }

 private:
  TrialParameters parameters_;
  const std::function<void()>& check_in_;
  TrialOutcome outcome_{};
  bool taken_{false};
};

}  // namespace

TrialOutcome TrialRunner::run(const TrialParameters& parameters, const std::function<void()>& check_in) {
  SingleTrial trial(parameters, check_in);
  run(trial);
  return trial.outcome();
}

std::unique_ptr<TrialRunner> make_runner(const IntegratorChoice& integrator, InstructionSet set) {
  switch (integrator.method) {
    case IntegratorChoice::Method::cvode:
      return std::make_unique<CvodeRunner>(integrator.tolerance, integrator.metrics);
    case IntegratorChoice::Method::lockstep:
      return std::make_unique<LockstepRouter>(integrator.tolerance, set, integrator.metrics);
  }
  throw RunFailure("unknown integration method");
}

}  // namespace steerstat
