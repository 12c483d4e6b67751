#pragma once

#include "integrate/arrival.hpp"
#include "integrate/lockstep_engine.hpp"

namespace steerstat {

/// The interpolant of a lane's last step.
class LaneOutput final : public DenseOutput {
 public:
  LaneOutput(const LockstepEngine& engine, int lane) : engine_(engine), lane_(lane) {}
  [[nodiscard]] State<double> at(double t) const override { return engine_.dense_output(lane_, t); }

 private:
  const LockstepEngine& engine_;
  int lane_;
};

}  // namespace steerstat
