#include "integrate/lockstep_integrator.hpp"

#include "integrate/exertion_meter.hpp"

namespace steerstat {
namespace {

/// A lane's last step.
class LaneOutput final : public DenseOutput {
 public:
  LaneOutput(const LockstepEngine& engine, int lane) : engine_(engine), lane_(lane) {}
  [[nodiscard]] State<double> at(double t) const override { return engine_.dense_output(lane_, t); }

 private:
  const LockstepEngine& engine_;
  int lane_;
};

}  // namespace

LockstepIntegrator::LockstepIntegrator(double tolerance, InstructionSet set, int lane, LoopKind kind)
    : engine_(make_lockstep_engine(tolerance, set, kind)), lane_(lane) {}

Arrival LockstepIntegrator::advance(const ClosedLoop<double>& loop, const Phase& phase, double t,
                                    const State<double>& x, double t_end, StepObserver* observer, Exertion* exertion) {
  engine_->seat(lane_, loop);
  Exertion nobody_asks;
  ExertionMeter meter(loop, phase, t, exertion != nullptr ? *exertion : nobody_asks);
  engine_->start(lane_, phase, t, x, t_end);
  const LaneOutput output(*engine_, lane_);
  double from = t;
  bool ended = false;
  while (!ended) {
    ended = engine_->step() != 0;
    const double to = engine_->arrival(lane_).t;
    if (observer != nullptr && to > from) observer->step(from, to, output);
    if (exertion != nullptr && to > from) meter.step(from, to, output);
    from = to;
  }
  const Arrival arrival = engine_->arrival(lane_);
  engine_->vacate(lane_);
  return arrival;
}

}  // namespace steerstat
