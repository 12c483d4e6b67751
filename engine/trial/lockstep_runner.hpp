#pragma once

#include <memory>
#include <vector>

#include "integrate/lockstep_engine.hpp"
#include "trial/contraction_record.hpp"
#include "trial/runner.hpp"
#include "trial/supervision.hpp"

namespace steerstat {

/// Runs trials side by side on the lockstep engine; a lane whose trial has ended takes the stream's next one. Not
/// thread-safe: one runner a thread.
class LockstepRunner final : public TrialRunner {
 public:
  /// @param metrics  whether effort and peaks are measured
  /// @param kind     of the trials it is given: an ideal runner would overlook imperfections
  LockstepRunner(double tolerance, InstructionSet set, bool metrics = true, LoopKind kind = LoopKind::ideal);

  using TrialRunner::run;
  void run(TrialStream& stream) override;

  [[nodiscard]] const LockstepEngine& engine() const { return *engine_; }

 private:
  /// The trial in a lane.
  struct Seat {
    std::uint64_t index{0};
    TrialParameters parameters{};
    Supervision supervision{};
    ContractionRecord contraction{};
  };

  bool take_next(TrialStream& stream, int lane);
  void report(TrialStream& stream, int lane, Status status, double t, const State<double>& x);
  bool finish_phase(TrialStream& stream, int lane);
  bool carry_on(TrialStream& stream, int lane, double t, const State<double>& x);

  std::unique_ptr<LockstepEngine> engine_;
  std::vector<Seat> seats_;
  std::array<std::uint64_t, phase_names.size()> lanes_of_kind_{};  // by the phase that they are in
  bool metrics_;
};

}  // namespace steerstat
