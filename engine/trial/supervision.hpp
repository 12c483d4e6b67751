#pragma once

#include <cstdint>
#include <optional>

#include "control/supervisor.hpp"
#include "trial/trial.hpp"

namespace steerstat {

/// The supervisor of one trial, behind the sensor that it reads the state through: what a runner asks at a trial's
/// start and at the end of every phase. Not thread-safe.
class Supervision {
 public:
  /// Decides in state x at time t [s], upon the trial's next reading.
  ///
  /// @param phase  becomes the phase to run, if any, in terms of the true state, so that an integrator that knows no
  ///               sensor ends it where the reading says
  /// @return       the trial's end, if it ends
  std::optional<Status> decide(const TrialParameters& trial, double t, const State<double>& x, Phase& phase);

  /// What the last decision left.
  [[nodiscard]] const Memory& memory() const { return memory_; }

 private:
  Memory memory_{};
  std::uint64_t readings_{0};
};

}  // namespace steerstat
