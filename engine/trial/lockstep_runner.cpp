#include "trial/lockstep_runner.hpp"

#include <algorithm>
#include <bit>

#include "trial/course.hpp"

namespace steerstat {

LockstepRunner::LockstepRunner(double tolerance, InstructionSet set, LoopKind kind)
    : engine_(make_lockstep_engine(tolerance, set, kind)), seats_(static_cast<std::size_t>(engine_->lanes())) {}

/// Seats the stream's next trial that has any phase to run. @return false when the stream is dry
bool LockstepRunner::take_next(TrialStream& stream, int lane) {
  Seat& seat = seats_[static_cast<std::size_t>(lane)];
  while (stream.next(seat.index, seat.parameters)) {
    seat.supervision = Supervision{};
    engine_->seat(lane, closed_loop_of(seat.parameters));
    if (carry_on(stream, lane, 0.0, seat.parameters.start)) return true;
  }
  return false;
}

/// Decides at the end of a lane's phase. @return whether the trial goes on; else its outcome has been reported
bool LockstepRunner::carry_on(TrialStream& stream, int lane, double t, const State<double>& x) {
  Seat& seat = seats_[static_cast<std::size_t>(lane)];
  const TrialParameters& parameters = seat.parameters;
  const Decision decision = seat.supervision.decide(parameters, t, x);
  if (decision.outcome) {
    stream.finished(seat.index, outcome_of(*decision.outcome, t, x, seat.supervision.memory(), parameters.goal));
    return false;
  }
  engine_->start(lane, decision.phase, t, x, std::min(t + decision.phase.duration, parameters.controller.horizon));
  return true;
}

void LockstepRunner::run(TrialStream& stream) {
  std::uint64_t busy = 0;
  for (int lane = 0; lane < engine_->lanes(); ++lane) {
    if (take_next(stream, lane))
      busy |= std::uint64_t{1} << lane;
    else
      engine_->vacate(lane);
  }
  while (busy != 0) {
    for (std::uint64_t ended = engine_->step(); ended != 0; ended &= ended - 1) {
      const int lane = std::countr_zero(ended);
      const Seat& seat = seats_[static_cast<std::size_t>(lane)];
      const Arrival arrival = engine_->arrival(lane);
      bool goes_on = false;
      if (arrival.cause == Cause::failure) {
        stream.finished(seat.index, outcome_of(Status::integrator_failed, arrival.t, arrival.state,
                                               seat.supervision.memory(), seat.parameters.goal));
      } else {
        goes_on = carry_on(stream, lane, arrival.t, arrival.state);
      }
      if (!goes_on && !take_next(stream, lane)) {
        engine_->vacate(lane);
        busy &= ~(std::uint64_t{1} << lane);
      }
    }
  }
}

}  // namespace steerstat
