#include "trial/lockstep_runner.hpp"

#include <algorithm>
#include <bit>
#include <optional>

#include "trial/check_in_interval.hpp"
#include "trial/course.hpp"

namespace steerstat {
namespace {

std::uint64_t bit(int lane) {
  return std::uint64_t{1} << lane;
}

}  // namespace

LockstepRunner::LockstepRunner(double tolerance, InstructionSet set, bool metrics, LoopKind kind)
    : engine_(make_lockstep_engine(tolerance, set, kind, metrics)),
      seats_(static_cast<std::size_t>(engine_->lanes())),
      metrics_(metrics) {}

/// Seats the stream's next trial that has any phase to run. @return false when the stream is dry
bool LockstepRunner::take_next(TrialStream& stream, int lane) {
  Seat& seat = seats_[static_cast<std::size_t>(lane)];
  while (stream.next(seat.index, seat.parameters)) {
    seat.supervision = Supervision{};
    seat.contraction = ContractionRecord{};
    engine_->seat(lane, closed_loop_of(seat.parameters));
    if (metrics_) engine_->set_exertion(lane, exertion_at(seat.parameters.start, seat.parameters.goal.q1));
    if (carry_on(stream, lane, 0.0, seat.parameters.start)) return true;
  }
  return false;
}

/// Reports the outcome of a lane's trial, which ended in state x at time t.
void LockstepRunner::report(TrialStream& stream, int lane, Status status, double t, const State<double>& x) {
  const Seat& seat = seats_[static_cast<std::size_t>(lane)];
  TrialOutcome outcome = outcome_of(status, t, x, seat.supervision.memory(), seat.contraction, seat.parameters.goal);
  if (metrics_) report_exertion(engine_->exertion(lane), outcome);
  stream.finished(seat.index, outcome);
}

/// Decides at the end of a lane's phase. @return whether the trial goes on; else its outcome has been reported
bool LockstepRunner::carry_on(TrialStream& stream, int lane, double t, const State<double>& x) {
  Seat& seat = seats_[static_cast<std::size_t>(lane)];
  const TrialParameters& parameters = seat.parameters;
  if (metrics_ && exceeds_stroke(parameters, engine_->exertion(lane))) {
    report(stream, lane, Status::diverged, t, x);
    return false;
  }
  Phase phase;
  if (const std::optional<Status> ended = seat.supervision.decide(parameters, t, x, phase)) {
    report(stream, lane, *ended, t, x);
    return false;
  }
  seat.contraction.start(phase, t, x, parameters.goal, parameters.controller.horizon);
  for (std::uint64_t& lanes : lanes_of_kind_) lanes &= ~bit(lane);
  lanes_of_kind_[static_cast<std::size_t>(phase.kind)] |= bit(lane);
  engine_->start(lane, phase, t, x, std::min(t + phase.duration, parameters.controller.horizon));
  return true;
}

/// Goes on from the end of a lane's phase. @return whether a trial is in the lane still, this one or the stream's next
bool LockstepRunner::finish_phase(TrialStream& stream, int lane) {
  Seat& seat = seats_[static_cast<std::size_t>(lane)];
  const Arrival arrival = engine_->arrival(lane);
  if (arrival.cause == Cause::failure) {
    report(stream, lane, Status::integrator_failed, arrival.t, arrival.state);
  } else {
    seat.contraction.finish(arrival.state, seat.parameters.goal);
    if (carry_on(stream, lane, arrival.t, arrival.state)) return true;
  }
  if (take_next(stream, lane)) return true;
  engine_->vacate(lane);
  return false;
}

void LockstepRunner::run(TrialStream& stream) {
  CheckInInterval interval;
  std::uint64_t busy = 0;
  for (int lane = 0; lane < engine_->lanes(); ++lane) {
    if (take_next(stream, lane))
      busy |= bit(lane);
    else
      engine_->vacate(lane);
  }
  while (busy != 0) {
    if (interval.ends_with_step()) stream.check_in();
    const std::uint64_t ended = engine_->step();
    // One kind of phase after the other: what follows goes by it, and the processor guesses right more often.
    const auto lanes_of_kind = lanes_of_kind_;
    for (const std::uint64_t of_kind : lanes_of_kind) {
      for (std::uint64_t lanes = ended & of_kind; lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        if (!finish_phase(stream, lane)) busy &= ~bit(lane);
      }
    }
  }
}

}  // namespace steerstat
