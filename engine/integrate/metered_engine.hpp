#pragma once

#include <memory>
#include <vector>

#include "integrate/lockstep_engine.hpp"

namespace steerstat {

/// Measures the exertion of the trials of an engine that measures none itself, lane by lane on its dense output. That
/// is slow beside a kernel's own packs, and takes any loop. The motion is the engine's, to the bit.
class MeteredEngine final : public LockstepEngine {
 public:
  explicit MeteredEngine(std::unique_ptr<LockstepEngine> engine);

  [[nodiscard]] InstructionSet instruction_set() const override { return engine_->instruction_set(); }
  [[nodiscard]] int lanes() const override { return engine_->lanes(); }
  void seat(int lane, const ClosedLoop<double>& loop) override;
  void set_exertion(int lane, const Exertion& exertion) override;
  [[nodiscard]] Exertion exertion(int lane) const override;
  void start(int lane, const Phase& phase, double t, const State<double>& x, double t_end) override;
  void vacate(int lane) override;
  std::uint64_t step() override;
  [[nodiscard]] Arrival arrival(int lane) const override { return engine_->arrival(lane); }
  [[nodiscard]] State<double> dense_output(int lane, double t) const override { return engine_->dense_output(lane, t); }

 private:
  /// The trial in a lane.
  struct Seat {
    bool taken{false};
    ClosedLoop<double> loop{};
    Phase phase{};
    double start{0.0};    // [s] of the phase
    double reached{0.0};  // [s] up to which it is measured
    Exertion exertion{};
  };
  Seat& seat_of(int lane) { return seats_[static_cast<std::size_t>(lane)]; }

  std::unique_ptr<LockstepEngine> engine_;
  std::vector<Seat> seats_;
};

}  // namespace steerstat
