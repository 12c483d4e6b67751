#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#include "control/controller.hpp"
#include "control/goal.hpp"
#include "core/state.hpp"
#include "core/status.hpp"
#include "robot/plant.hpp"

namespace steerstat {

/// Everything that decides one trial.
struct TrialParameters {
  PlantParameters<double> nominal{};  ///< what the controller believes
  PlantParameters<double> plant{};    ///< what is true
  State<double> start{1.0, -0.7853981633974483, 0.0, 0.0};
  Goal goal{goal_at(0.0, 0.7853981633974483)};
  Controller controller{};  ///< its `coupling` is that of `nominal`
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

  /// [s] the end time of a converged trial, NaN of any other.
  [[nodiscard]] double settling_time() const {
    return status == Status::converged ? end_time : std::numeric_limits<double>::quiet_NaN();
  }

  friend bool operator==(const TrialOutcome&, const TrialOutcome&) = default;
};

/// Whether two outcomes are the same bits; unlike ==, a NaN equals itself and the two zeros differ.
inline bool same_bits(const TrialOutcome& a, const TrialOutcome& b) {
  const auto same = [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  };
  return a.status == b.status && a.cycles == b.cycles && a.swings == b.swings && a.alignments == b.alignments &&
         same(a.end_time, b.end_time) && same(a.end_state.q1, b.end_state.q1) && same(a.end_state.q2, b.end_state.q2) &&
         same(a.end_state.q1_dot, b.end_state.q1_dot) && same(a.end_state.q2_dot, b.end_state.q2_dot) &&
         same(a.passive_error, b.passive_error) && same(a.active_error, b.active_error);
}

}  // namespace steerstat
