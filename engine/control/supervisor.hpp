#pragma once

#include <cstdint>
#include <optional>

#include "control/controller.hpp"
#include "control/experience.hpp"
#include "control/goal.hpp"
#include "control/phase.hpp"
#include "core/state.hpp"
#include "core/status.hpp"

namespace steerstat {

/// What the supervisor remembers from one decision to the next.
struct Memory {
  std::optional<PhaseKind> last{};  ///< the phase that just ended; none before the first
  std::uint32_t decisions{0};       ///< passes through the rules that chose a phase
  std::uint32_t cycles{0};          ///< contraction cycles started
  std::uint32_t swings{0};          ///< swings started
  std::uint32_t alignments{0};      ///< alignments started
  double pace{1.0};                 ///< of the last align
  Experience experience{};          ///< robust policy: what it learned of the trial

  friend bool operator==(const Memory&, const Memory&) = default;
};

/// What the supervisor decided: a phase to run, or the trial's end.
struct Decision {
  std::optional<Status> outcome{};  ///< set: the trial stops with it, and `phase` means nothing
  Phase phase{};
  Memory memory{};
};

/// A trial that has decided this often stops with Status::timeout.
inline constexpr std::uint32_t most_decisions = 10000;

/// The supervisor, called at the start of a trial and at the end of every phase: rules 1-7 of CONTROLLER.md section 5
/// (§4.2 of the paper) or, under Policy::robust, those of README.md beside this file. A pure function; its bits do not
/// depend on the machine.
///
/// @param t       [s] since the trial's start
/// @param x       measured state
/// @param memory  what the decision before this one returned; `Memory{}` at the start
inline Decision decide(double t, const State<double>& x, const Memory& memory, const Controller& controller,
                       const Goal& goal);

/// The same in place: to copy a decision takes as long as to make it.
///
/// @param memory  becomes the new one
/// @param phase   becomes the phase to run, if any
/// @return        the trial's end, if it ends
std::optional<Status> decide(double t, const State<double>& x, const Controller& controller, const Goal& goal,
                             Memory& memory, Phase& phase);

inline Decision decide(double t, const State<double>& x, const Memory& memory, const Controller& controller,
                       const Goal& goal) {
  Decision decision{std::nullopt, Phase{}, memory};
  decision.outcome = decide(t, x, controller, goal, decision.memory, decision.phase);
  return decision;
}

}  // namespace steerstat
