#include "integrate/metered_engine.hpp"

#include <utility>

#include "integrate/exertion_meter.hpp"
#include "integrate/lane_output.hpp"

namespace steerstat {

MeteredEngine::MeteredEngine(std::unique_ptr<LockstepEngine> engine)
    : engine_(std::move(engine)), seats_(static_cast<std::size_t>(engine_->lanes())) {}

void MeteredEngine::seat(int lane, const ClosedLoop<double>& loop) {
  engine_->seat(lane, loop);
  seat_of(lane) = Seat{true, loop, {}, 0.0, 0.0, {}};
}

void MeteredEngine::set_exertion(int lane, const Exertion& exertion) {
  seat_of(lane).exertion = exertion;
}

Exertion MeteredEngine::exertion(int lane) const {
  return seats_[static_cast<std::size_t>(lane)].exertion;
}

void MeteredEngine::start(int lane, const Phase& phase, double t, const State<double>& x, double t_end) {
  engine_->start(lane, phase, t, x, t_end);
  Seat& seat = seat_of(lane);
  seat.phase = phase;
  seat.start = seat.reached = t;
}

void MeteredEngine::vacate(int lane) {
  engine_->vacate(lane);
  seat_of(lane).taken = false;
}

std::uint64_t MeteredEngine::step() {
  const std::uint64_t ended = engine_->step();
  counters_ = engine_->counters();
  for (int lane = 0; lane < lanes(); ++lane) {
    Seat& seat = seat_of(lane);
    if (!seat.taken) continue;
    const double t = engine_->arrival(lane).t;
    // A step that is taken back leads nowhere.
    if (t > seat.reached) {
      ExertionMeter(seat.loop, seat.phase, seat.start, seat.exertion).step(seat.reached, t, LaneOutput(*engine_, lane));
    }
    seat.reached = t;
  }
  return ended;
}

}  // namespace steerstat
