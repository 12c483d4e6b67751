#pragma once

#include <cstdint>
#include <memory>

#include "control/phase.hpp"
#include "core/instruction_set.hpp"
#include "core/state.hpp"
#include "integrate/arrival.hpp"
#include "integrate/closed_loop.hpp"

namespace steerstat {

/// Integrates the phases of many trials at once, one a lane, each with its own plant, law, time and step size: a Taylor
/// series a step, guards located on the step's own polynomial.
///
/// What a lane computes depends on its own trial alone: not on the lane, the number of lanes, the instruction set or
/// the trials beside it. Not thread-safe: one engine a thread.
class LockstepEngine {
 public:
  /// Work done since the engine was made.
  struct Counters {
    std::uint64_t steps{0};       ///< of a pack
    std::uint64_t lane_slots{0};  ///< steps of all lanes
    std::uint64_t lane_steps{0};  ///< steps of lanes with a trial in them
    std::uint64_t searches{0};    ///< for a guard on a lane's polynomial
    std::uint64_t arrivals{0};    ///< phases that ended
  };

  LockstepEngine() = default;
  LockstepEngine(const LockstepEngine&) = delete;
  LockstepEngine& operator=(const LockstepEngine&) = delete;
  virtual ~LockstepEngine() = default;

  [[nodiscard]] virtual InstructionSet instruction_set() const = 0;

  /// @return how many lanes, at most 64
  [[nodiscard]] virtual int lanes() const = 0;

  /// Gives a lane to a trial. @param loop  its closed loop; only a LoopKind::imperfect engine takes imperfections
  virtual void seat(int lane, const ClosedLoop<double>& loop) = 0;

  /// Starts a phase in a seated lane. @param phase  only a LoopKind::imperfect engine takes its offsets, @param t, x
  /// time [s] and state, @param t_end  [s] > t, no phase runs past it
  virtual void start(int lane, const Phase& phase, double t, const State<double>& x, double t_end) = 0;

  /// Takes a lane out of the work.
  virtual void vacate(int lane) = 0;

  /// Advances every seated lane by one step. @return a bit for each lane whose phase has ended
  virtual std::uint64_t step() = 0;

  /// Where the phase of a lane ended, or stands.
  [[nodiscard]] virtual Arrival arrival(int lane) const = 0;

  /// The state of a lane at t [s] within its last step.
  [[nodiscard]] virtual State<double> dense_output(int lane, double t) const = 0;

  [[nodiscard]] const Counters& counters() const { return counters_; }

 protected:
  Counters counters_;
};

/// Which closed loops an engine takes.
enum class LoopKind : std::uint8_t {
  ideal,      ///< without imperfections; the fast engine
  imperfect,  ///< any; of those without imperfections the bits differ from the fast engine's
};

/// @param tolerance  bound on a step's local error in each velocity [m/s, rad/s]; a step aims at an eighth of it
/// @param set        one that supports(set)
std::unique_ptr<LockstepEngine> make_lockstep_engine(double tolerance, InstructionSet set,
                                                     LoopKind kind = LoopKind::ideal);

}  // namespace steerstat
