#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/instruction_set.hpp"
#include "fma_peak.hpp"
#include "operations.hpp"

namespace steerstat::bench {

/// The parts of the lockstep runner's work that its time is divided among.
enum class Part : std::size_t { series, step, guards, supervisor, runner, draws, other };
inline constexpr std::array<std::string_view, 7> part_names{"Taylor series",
                                                            "rest of the step",
                                                            "guard search",
                                                            "supervisor",
                                                            "phase starts, refill, stores",
                                                            "parameters drawn",
                                                            "other"};

/// Where the lockstep runner's time goes on one instruction set.
struct Anatomy {
  double lane_steps_per_trial;
  double arrivals_per_trial;                     ///< phase ends
  double searches_per_trial;                     ///< for a guard, on a step's polynomial
  double occupancy;                              ///< share of lanes with a trial in them
  double ns_per_lane_step;                       ///< CPU time, all of the runner's work, median of repetitions
  std::array<double, part_names.size()> shares;  ///< of time, sampled a thousand times a second
  std::size_t samples;
  StepOperations operations;  ///< of one lane in one step
  /// A function and its share of time, largest first.
  struct Function {
    std::string name;
    double share;
  };
  std::vector<Function> functions;
};

/// @param seconds  of one repetition
Anatomy dissect_lockstep(InstructionSet set, double tolerance, double seconds, int repetitions);

/// The share of the peak that `operations` a lane-step in `ns` come to: the time they would take at the peak over the
/// time they take, single precision counted at its own peak.
double share_of_peak(const Operations& operations, double ns, const FmaPeak& peak);

}  // namespace steerstat::bench
