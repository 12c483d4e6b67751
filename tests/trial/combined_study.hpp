#pragma once

#include <numbers>
#include <random>
#include <vector>

#include "trial/trial.hpp"

namespace steerstat::testing {

/// Trials of the combined study: uniform m1, m2 in [0.8, 1.2], f1, f2 in [0, 0.05], q1 in [-1, 1], q2 in [-pi, pi],
/// velocities in [-0.5, 0.5]. Always the same ones; fewer are the first of more.
inline std::vector<TrialParameters> combined_study(std::size_t trials) {
  std::mt19937_64 generator(7);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(generator() >> 11) * 0x1p-53);
  };
  std::vector<TrialParameters> study(trials);
  for (TrialParameters& trial : study) {
    trial.plant.m1 = uniform(0.8, 1.2);
    trial.plant.m2 = uniform(0.8, 1.2);
    trial.plant.f1 = uniform(0.0, 0.05);
    trial.plant.f2 = uniform(0.0, 0.05);
    trial.start.q1 = uniform(-1.0, 1.0);
    trial.start.q2 = uniform(-std::numbers::pi, std::numbers::pi);
    trial.start.q1_dot = uniform(-0.5, 0.5);
    trial.start.q2_dot = uniform(-0.5, 0.5);
  }
  return study;
}

}  // namespace steerstat::testing
