#pragma once

#include <memory>

#include "integrate/exertion.hpp"
#include "integrate/lockstep_engine.hpp"

namespace steerstat {

/// The lockstep engine, one phase of one trial at a time: for replay and for tests. The bits are those of the same
/// phase in a full pack. Not thread-safe.
class LockstepIntegrator {
 public:
  /// @param tolerance  local error per step
  /// @param kind       which loops it takes
  explicit LockstepIntegrator(double tolerance, InstructionSet set = best_instruction_set(), int lane = 0,
                              LoopKind kind = LoopKind::ideal);

  /// Integrates one phase. @param t, x  time [s] and state at its start, @param t_end  [s] > t, where it ends unless a
  /// guard of `phase` fires first, @param observer  watches the steps; may be null, @param exertion  of the course so
  /// far, brought up to date; null where nobody asks
  Arrival advance(const ClosedLoop<double>& loop, const Phase& phase, double t, const State<double>& x, double t_end,
                  StepObserver* observer = nullptr, Exertion* exertion = nullptr);

 private:
  std::unique_ptr<LockstepEngine> engine_;
  int lane_;
};

}  // namespace steerstat
