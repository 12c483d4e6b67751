#pragma once

#include <memory>

#include "trial/lockstep_runner.hpp"
#include "trial/runner.hpp"

namespace steerstat {

/// Runs trials on lockstep engines, those without imperfections on the fast one. Each trial goes where its own
/// parameters say, so that its bits depend on nothing else. Not thread-safe: one router a thread.
class LockstepRouter final : public TrialRunner {
 public:
  /// @param metrics  whether effort and peaks are measured
  LockstepRouter(double tolerance, InstructionSet set, bool metrics);

  using TrialRunner::run;
  void run(TrialStream& stream) override;

 private:
  double tolerance_;
  InstructionSet set_;
  bool metrics_;
  LockstepRunner ideal_;
  std::unique_ptr<LockstepRunner> imperfect_;  // made when first needed
};

}  // namespace steerstat
