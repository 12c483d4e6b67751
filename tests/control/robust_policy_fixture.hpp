#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "control/cycle.hpp"
#include "control/robust_alignment.hpp"
#include "control/robust_policy.hpp"
#include "control/supervisor.hpp"
#include "supervision_fixture.hpp"

/// What the tests of the robust policy stand on. The goal is pi/4, where y = q2.
namespace steerstat::testing {

inline const double delta = 0.5 * std::asin(0.5);

struct Robot {
  Controller controller{};
  Goal goal{goal_at(0.0, pi / 4)};
  Experience experience{};

  Robot() { controller.policy = Policy::robust; }

  [[nodiscard]] Phase steer(double q2, double q2_dot, double q1 = 0.0) const {
    return steer_robustly({q1, q2, 0.0, q2_dot}, experience, controller, goal);
  }
  [[nodiscard]] Decision after(PhaseKind last, const State<double>& x, double t = 1.0) const {
    Memory memory{last};
    memory.experience = experience;
    return decide(t, x, memory, controller, goal);
  }
};

/// What a cycle of the nominal robot changes the speed by, with the joint about `mean`: (13).
inline double push_of(const Phase& cycle, double mean) {
  const double K = Controller{}.coupling;
  return K * K * beta * std::abs(std::sin(2.0 * mean)) * cycle.amplitude * cycle.amplitude / cycle.duration;
}

}  // namespace steerstat::testing
