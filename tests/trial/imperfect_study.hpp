#pragma once

#include <random>
#include <vector>

#include "combined_study.hpp"

namespace steerstat::testing {

/// Trials of the combined study with every imperfection, small enough that many converge.
inline std::vector<TrialParameters> imperfect_study(std::size_t trials) {
  std::vector<TrialParameters> study = combined_study(trials);
  std::mt19937_64 generator(17);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(generator() >> 11) * 0x1p-53);
  };
  for (TrialParameters& trial : study) {
    trial.plant.f2 *= 0.1;
    trial.disturbance.coulomb1 = uniform(0.0, 0.01);
    trial.disturbance.coulomb2 = uniform(0.0, 1e-4);
    trial.disturbance.coulomb_speed1 = uniform(1e-3, 1e-2);
    trial.disturbance.coulomb_speed2 = uniform(1e-3, 1e-2);
    trial.disturbance.gravity_x = uniform(-1e-3, 1e-3);
    trial.disturbance.gravity_y = uniform(-3e-5, 3e-5);
    trial.actuator.gain = uniform(0.95, 1.05);
    trial.actuator.max_force = uniform(5.0, 40.0);
    trial.sensor.bias = {uniform(-1e-2, 1e-2), uniform(-1e-3, 1e-3), uniform(-1e-4, 1e-4), uniform(-1e-4, 1e-4)};
    trial.sensor.noise = {1e-4, 1e-4, 1e-4, 1e-4};
    trial.sensor.noise_seed = generator();
  }
  return study;
}

}  // namespace steerstat::testing
