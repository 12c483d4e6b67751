#pragma once

#include "integrate/cvode_integrator.hpp"
#include "trial/runner.hpp"

namespace steerstat {

/// Runs trials one after another on the reference integrator. Not thread-safe: one runner a thread.
class CvodeRunner final : public TrialRunner {
 public:
  /// @param metrics  whether effort and peaks are measured
  /// @throws RunFailure where SUNDIALS cannot be set up
  explicit CvodeRunner(double tolerance, bool metrics = true);

  using TrialRunner::run;
  void run(TrialStream& stream) override;

 private:
  CvodeIntegrator integrator_;
  bool metrics_;
};

}  // namespace steerstat
