#pragma once

#include "control/controller.hpp"
#include "control/experience.hpp"
#include "control/goal.hpp"
#include "control/phase.hpp"
#include "core/state.hpp"

namespace steerstat {

/// Learns from the leg that `experience` tells of, which has ended in state x (README.md section 3). No leg is under
/// way in it afterwards.
void learn(const State<double>& x, const Controller& controller, const Goal& goal, Experience& experience);

/// Notes that `phase` starts in state x: a leg is under way unless the phase is an align.
void embark(const Phase& phase, const State<double>& x, Experience& experience);

/// The drift or cycle to run in state x, aligned: the first of the rules of README.md section 4 that holds. A pure
/// function; its bits do not depend on the machine.
///
/// @param x  measured, finite, not converged
Phase steer_robustly(const State<double>& x, const Experience& experience, const Controller& controller,
                     const Goal& goal);

/// Share of r e [rad/s] from which on the joint is too fast and brakes (README.md section 4, rule 1).
inline constexpr double braking_share = 0.9;

/// What rule 1 of README.md section 4 aims at.
struct BrakingAim {
  double distance_after_cycle;  ///< [rad] e, to the goal
  double distance_after_align;  ///< [rad] with an align of the expected duration
  double speed;                 ///< [rad/s] omega, from the cycle's end on
};

/// The aim of a cycle that brakes from state x.
BrakingAim braking_aim(const State<double>& x, const Controller& controller, const Goal& goal);

}  // namespace steerstat
