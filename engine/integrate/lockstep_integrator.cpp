#include "integrate/lockstep_integrator.hpp"

#include "integrate/lane_output.hpp"

namespace steerstat {
LockstepIntegrator::LockstepIntegrator(double tolerance, InstructionSet set, int lane, LoopKind kind)
    : engine_(make_lockstep_engine(tolerance, set, kind, true)), lane_(lane) {}

Arrival LockstepIntegrator::advance(const ClosedLoop<double>& loop, const Phase& phase, double t,
                                    const State<double>& x, double t_end, StepObserver* observer, Exertion* exertion) {
  engine_->seat(lane_, loop);
  if (exertion != nullptr) engine_->set_exertion(lane_, *exertion);
  engine_->start(lane_, phase, t, x, t_end);
  const LaneOutput output(*engine_, lane_);
  double from = t;
  bool ended = false;
  while (!ended) {
    ended = engine_->step() != 0;
    const double to = engine_->arrival(lane_).t;
    if (observer != nullptr && to > from) observer->step(from, to, output);
    from = to;
  }
  const Arrival arrival = engine_->arrival(lane_);
  if (exertion != nullptr) *exertion = engine_->exertion(lane_);
  engine_->vacate(lane_);
  return arrival;
}

}  // namespace steerstat
