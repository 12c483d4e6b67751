#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#include "control/controller.hpp"
#include "control/goal.hpp"
#include "core/state.hpp"
#include "core/status.hpp"
#include "robot/actuator.hpp"
#include "robot/disturbance.hpp"
#include "robot/plant.hpp"
#include "trial/sensor.hpp"

namespace steerstat {

/// Everything that decides one trial.
struct TrialParameters {
  PlantParameters<double> nominal{};  ///< what the controller believes
  PlantParameters<double> plant{};    ///< what is true
  State<double> start{1.0, -0.7853981633974483, 0.0, 0.0};
  Goal goal{goal_at(0.0, 0.7853981633974483)};
  Controller controller{};            ///< its `coupling` is that of `nominal`
  Disturbance<double> disturbance{};  ///< forces that the controller knows nothing of
  Actuator<double> actuator{};
  Sensor sensor{};
};

/// What a trial has where a quantity does not exist in it.
inline constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

/// How much the finished contraction cycles of a trial left of an error: end over start of each, the paper's eta (§4.1)
/// as achieved.
struct ContractionRatios {
  double mean{no_value};   ///< NaN where no cycle finished
  double worst{no_value};  ///< the one of the largest magnitude, with its sign
};

/// What one trial reports.
struct TrialOutcome {
  Status status{Status::integrator_failed};
  std::uint32_t cycles{0};      ///< contraction cycles started
  std::uint32_t swings{0};      ///< swings started
  std::uint32_t alignments{0};  ///< alignments started
  double end_time{0.0};         ///< [s]
  State<double> end_state{};
  double passive_error{0.0};  ///< rad + rad/s, at the end
  double active_error{0.0};   ///< norm of m and m/s, at the end

  double effort{no_value};                   ///< [N^2 s] integral of tau^2
  double peak_acceleration{no_value};        ///< [m/s^2] largest |a|
  double peak_force{no_value};               ///< [N] largest |tau|
  double peak_stroke{no_value};              ///< [m] largest |q1 - q1_goal|
  ContractionRatios position_contraction{};  ///< of e = w - u, the distance to go
  ContractionRatios velocity_contraction{};  ///< of omega, the speed towards the goal

  /// [s] the end time of a converged trial, NaN of any other.
  [[nodiscard]] double settling_time() const { return status == Status::converged ? end_time : no_value; }
};

/// Whether two outcomes are the same bits: a NaN equals itself, and the two zeros differ.
inline bool same_bits(const TrialOutcome& a, const TrialOutcome& b) {
  const auto same = [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  };
  return a.status == b.status && a.cycles == b.cycles && a.swings == b.swings && a.alignments == b.alignments &&
         same(a.end_time, b.end_time) && same(a.end_state.q1, b.end_state.q1) && same(a.end_state.q2, b.end_state.q2) &&
         same(a.end_state.q1_dot, b.end_state.q1_dot) && same(a.end_state.q2_dot, b.end_state.q2_dot) &&
         same(a.passive_error, b.passive_error) && same(a.active_error, b.active_error) && same(a.effort, b.effort) &&
         same(a.peak_acceleration, b.peak_acceleration) && same(a.peak_force, b.peak_force) &&
         same(a.peak_stroke, b.peak_stroke) && same(a.position_contraction.mean, b.position_contraction.mean) &&
         same(a.position_contraction.worst, b.position_contraction.worst) &&
         same(a.velocity_contraction.mean, b.velocity_contraction.mean) &&
         same(a.velocity_contraction.worst, b.velocity_contraction.worst);
}

inline bool operator==(const TrialOutcome& a, const TrialOutcome& b) {
  return same_bits(a, b);
}

}  // namespace steerstat
