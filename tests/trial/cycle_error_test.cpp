#include "trial/cycle_error.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "../robot/runge_kutta.hpp"
#include "control/cycle.hpp"

namespace steerstat {
namespace {

constexpr double tolerance = 1e-12;
constexpr double coupling_of_default = 0.4;

const std::array<Cycle, 5> cycles{{{0.4, 0.3, 40.0, 2.0},
                                   {1.2, -0.5, 100.0, 1.0},
                                   {0.9, 0.05, -60.0, 4.0},
                                   {0.2, 0.1, 200.0, 8.0},
                                   {0.7, 0.02, 5.0, 0.5}}};

/// The real second joint at the end of a cycle, by fixed steps in extended precision.
State<long double> real_end(const Cycle& cycle) {
  const auto period = static_cast<long double>(cycle.period);
  const auto amplitude = static_cast<long double>(cycle.amplitude);
  return testing::integrated<State<long double>>(
      {0.0L, cycle.q2, 0.0L, cycle.q2_dot}, period, 6000, [&](const State<long double>& x, long double t) {
        const long double a = cycle_acceleration(amplitude, period, t);
        return State<long double>{x.q1_dot, x.q2_dot, a, 0.4L * std::sin(x.q2) * a};
      });
}

TEST(CycleComparison, EndsWhereAnIndependentIntegratorDoesAndErrsAs12And13Do) {
  CycleComparison comparison({}, tolerance);
  for (const Cycle& cycle : cycles) {
    const auto end = real_end(cycle);
    const double step = -2.0 * coupling_of_default * coupling_of_default * std::sin(cycle.q2) * std::cos(cycle.q2) *
                        beta * cycle.amplitude * cycle.amplitude / cycle.period;
    const double position = std::abs(static_cast<double>(end.q2) - cycle.q2 - cycle.q2_dot * cycle.period);
    const double velocity = std::abs(static_cast<double>(end.q2_dot) - cycle.q2_dot - step);
    const CycleError error = comparison.error_of(cycle);
    EXPECT_NEAR(error.end.position, position, 1e-10);
    EXPECT_NEAR(error.end.velocity, velocity, 1e-10);
    EXPECT_NEAR(error.end.state, std::hypot(position, velocity), 1e-10);
    EXPECT_NEAR(error.position_step, position / std::abs(cycle.q2_dot * cycle.period), 1e-7);
    EXPECT_NEAR(error.velocity_step, velocity / std::abs(step), 1e-9 / std::abs(step));
  }
}

TEST(CycleComparison, TheWorstWithinACycleIsNoBetterThanItsEnd) {
  CycleComparison comparison({}, tolerance);
  for (const Cycle& cycle : cycles) {
    const CycleError error = comparison.error_of(cycle);
    EXPECT_GE(error.worst.position, error.end.position);
    EXPECT_GE(error.worst.velocity, error.end.velocity);
    EXPECT_GE(error.worst.state, error.end.state);
  }
}

TEST(CycleComparison, ACourseStartsWithoutErrorAndTouchesTheCyclesEnds) {
  CycleComparison comparison({}, tolerance);
  const auto course = comparison.course_of(cycles[0], 200);
  ASSERT_EQ(course.size(), 201U);
  EXPECT_EQ(course.front().t, 0.0);
  EXPECT_EQ(course.back().t, cycles[0].period);
  EXPECT_EQ(course.front().q2, course.front().approximate_q2);
  EXPECT_EQ(course.front().q2_dot, course.front().approximate_q2_dot);
  EXPECT_NEAR(std::abs(course.back().q2 - course.back().approximate_q2), comparison.error_of(cycles[0]).end.position,
              1e-15);
}

TEST(CycleComparison, QuadrantsAreMirrorImages) {
  CycleComparison comparison({}, tolerance);
  for (const Cycle& cycle : cycles) {
    const CycleError error = comparison.error_of(cycle);
    const CycleError mirrored = comparison.error_of({-cycle.q2, -cycle.q2_dot, cycle.amplitude, cycle.period});
    const CycleError turned =
        comparison.error_of({std::numbers::pi - cycle.q2, -cycle.q2_dot, -cycle.amplitude, cycle.period});
    for (const CycleError& other : {mirrored, turned}) {
      EXPECT_NEAR(other.end.velocity, error.end.velocity, 1e-11);
      EXPECT_NEAR(other.worst.position, error.worst.position, 1e-11);
    }
  }
}

TEST(CycleComparison, ErrsWithOrderFourAtTheEndAsItsAccelerationLastsLonger) {
  // Homogeneity (see tests/robot/cycle_response_test.cpp), where the errors are still far above the integration's.
  CycleComparison comparison({}, 1e-14);
  const auto error = [&](double scale) { return comparison.error_of({0.4, 0.3, 25.0 * scale * scale, scale}); };
  const CycleError coarse = error(0.1);
  const CycleError fine = error(0.05);
  EXPECT_NEAR(std::log2(coarse.end.velocity / fine.end.velocity), 4.0, 0.15);
  EXPECT_NEAR(std::log2(coarse.end.position / fine.end.position), 4.0, 0.15);
}

TEST(CycleComparison, WhatItComputesDoesNotDependOnTheCyclesBefore) {
  CycleComparison one({}, tolerance);
  const CycleError first = one.error_of(cycles[0]);
  for (const Cycle& cycle : cycles) one.error_of(cycle);
  EXPECT_EQ(one.error_of(cycles[0]), first);
}

}  // namespace
}  // namespace steerstat
