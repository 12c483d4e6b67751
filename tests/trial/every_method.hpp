#pragma once

#include <gtest/gtest.h>

#include <string>

#include "trial/runner.hpp"

namespace steerstat::testing {

/// Tests that each integration method must pass.
class EveryMethod : public ::testing::TestWithParam<IntegratorChoice::Method> {
 protected:
  [[nodiscard]] static IntegratorChoice integrator(double tolerance = 1e-9) { return {GetParam(), tolerance}; }
  [[nodiscard]] static TrialOutcome run(const TrialParameters& parameters) {
    return make_runner(integrator())->run(parameters);
  }
};

inline std::string method_name(const ::testing::TestParamInfo<IntegratorChoice::Method>& info) {
  return std::string(IntegratorChoice::method_names[static_cast<std::size_t>(info.param)]);
}

inline auto every_method() {
  return ::testing::Values(IntegratorChoice::Method::cvode, IntegratorChoice::Method::lockstep);
}

}  // namespace steerstat::testing
