#pragma once

#include <cstdint>
#include <memory>

#include "control/phase.hpp"
#include "core/instruction_set.hpp"
#include "core/state.hpp"
#include "integrate/arrival.hpp"
#include "integrate/closed_loop.hpp"
#include "integrate/exertion.hpp"

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

  /// Gives a lane to a trial, whose exertion is none until it is set. @param loop  its closed loop; only a
  /// LoopKind::imperfect engine takes imperfections
  virtual void seat(int lane, const ClosedLoop<double>& loop) = 0;

  /// Sets the exertion of a lane's trial up to now. Without effect where the engine measures none.
  virtual void set_exertion(int lane, const Exertion& exertion);

  /// The exertion of a lane's trial up to its last step's end, or to where its phase ended; none where the engine
  /// measures none.
  [[nodiscard]] virtual Exertion exertion(int lane) const;

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
  /// Adds what a lane's last step asked between from and to [s], by its dense output. (Kernels share no inline function
  /// with other sources; see core/instruction_set.hpp.)
  ///
  /// @param start  of the phase [s]
  void meter(const ClosedLoop<double>& loop, const Phase& phase, double start, double from, double to, int lane,
             Exertion& exertion) const;

  /// The largest |a| of a cycle up to t [s] since its start.
  static double peak_of_cycle(const Phase& cycle, double t);

  Counters counters_;
};

/// Which closed loops an engine takes.
enum class LoopKind : std::uint8_t {
  ideal,      ///< without imperfections; the fast engine
  imperfect,  ///< any; of those without imperfections the bits differ from the fast engine's
};

/// @param tolerance  bound on a step's local error in each velocity [m/s, rad/s]; a step aims at an eighth of it
/// @param set        one that supports(set)
/// @param measured   whether trials' exertion is measured; their motion is the same bits
std::unique_ptr<LockstepEngine> make_lockstep_engine(double tolerance, InstructionSet set,
                                                     LoopKind kind = LoopKind::ideal, bool measured = false);

}  // namespace steerstat
