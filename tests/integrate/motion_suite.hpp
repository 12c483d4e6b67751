#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "integrator_fixture.hpp"

/// Closed loops whose motion is known, and what the steps must be.
namespace steerstat::testing {

template <class Integrator>
class IntegratorMotion : public IntegratorTest<Integrator> {};

TYPED_TEST_SUITE_P(IntegratorMotion);

TYPED_TEST_P(IntegratorMotion, AlignIsADampedOscillator) {
  for (const Oscillator& oscillator : {Oscillator{2.5, std::sqrt(0.75)}, Oscillator{0.1, 2.0}}) {
    for (const double duration : {0.01, 0.7, 5.0}) {
      const Arrival arrival =
          this->advance(oscillator.loop(), align_phase(-1.0), 0.0, this->state_of(oscillator, 0.0), duration);
      ASSERT_EQ(arrival.cause, Cause::time);
      EXPECT_EQ(arrival.t, duration);
      const auto [e, v] = oscillator.at(duration);
      EXPECT_NEAR(arrival.state.q1, e, error_growth * 1e-9);
      EXPECT_NEAR(arrival.state.q1_dot, v, error_growth * 1e-9);
    }
  }
}

TYPED_TEST_P(IntegratorMotion, CycleMovesTheFirstJointAlongItsPolynomial) {
  const double period = 1.7;
  const double amplitude = 30.0;
  for (const double fraction : {0.1, 0.5, 0.83, 1.0}) {
    const double t_end = 4.0 + fraction * period;
    const Arrival arrival =
        this->advance(exact_loop(), cycle_phase(amplitude, period), 4.0, {0.0, 0.3, 0.0, 0.1}, t_end);
    ASSERT_EQ(arrival.cause, Cause::time);
    EXPECT_EQ(arrival.t, t_end);
    const auto [q1, q1_dot] = cycle_motion(amplitude, period, fraction * period);
    EXPECT_NEAR(arrival.state.q1, q1, error_growth * 1e-9);
    EXPECT_NEAR(arrival.state.q1_dot, q1_dot, error_growth * 1e-9);
  }
}

// A contraction right before the goal lasts microseconds, at accelerations to match.
TYPED_TEST_P(IntegratorMotion, AVeryShortCycleIsNoFailure) {
  const double period = 1.6e-5;
  const double amplitude = 0.3;
  const double fastest = 0.03 * amplitude / period;
  for (const double fraction : {0.5, 1.0}) {
    const double t_end = fraction * period;
    const Arrival arrival =
        this->advance(exact_loop(), cycle_phase(amplitude, period), 0.0, {0.0, 0.78, 0.0, 0.1}, t_end);
    ASSERT_EQ(arrival.cause, Cause::time);
    const auto [q1, q1_dot] = cycle_motion(amplitude, period, t_end);
    EXPECT_NEAR(arrival.state.q1, q1, error_growth * 1e-9);
    EXPECT_NEAR(arrival.state.q1_dot, q1_dot, error_growth * 1e-9 * fastest);
  }
}

TYPED_TEST_P(IntegratorMotion, DriftOfAnExactPlantIsUniform) {
  const Arrival arrival =
      this->advance(exact_loop(), drift_phase(-Phase::unbounded, Phase::unbounded), 10.0, {0.2, -1.0, 0.03, 0.4}, 60.0);
  ASSERT_EQ(arrival.cause, Cause::time);
  EXPECT_LT(distance(arrival.state, {0.2 + 50.0 * 0.03, -1.0 + 50.0 * 0.4, 0.03, 0.4}), error_growth * 1e-9);
}

TYPED_TEST_P(IntegratorMotion, AFreePlantKeepsItsEnergyAndItsMomentum) {
  const PlantParameters<double> plant{1.2, 0.8, 0.7, 0.3, 0.0, 0.0};
  const ClosedLoop<double> loop = free_loop(plant);
  const State<double> x0{0.0, 0.5, 0.3, 1.5};
  const Arrival arrival = this->advance(loop, drift_phase(-Phase::unbounded, Phase::unbounded), 0.0, x0, 9.0);
  ASSERT_GT(std::abs(arrival.state.q2_dot - x0.q2_dot), 0.05) << "the joints exchange energy";
  const auto momentum = [&](const State<double>& x) {
    return loop.plant.mass * x.q1_dot - loop.plant.moment * std::sin(x.q2) * x.q2_dot;
  };
  EXPECT_NEAR(kinetic_energy(loop.plant, arrival.state, std::sin(arrival.state.q2)),
              kinetic_energy(loop.plant, x0, std::sin(x0.q2)), error_growth * 1e-9);
  EXPECT_NEAR(momentum(arrival.state), momentum(x0), error_growth * 1e-9);
}

TYPED_TEST_P(IntegratorMotion, ADriftWithoutFrictionRunsBackToItsStart) {
  ClosedLoop<double> loop = exact_loop();
  loop.plant = constants_of(PlantParameters<double>{1.2, 0.8, 0.7, 0.3, 0.0, 0.0});
  const Phase drift = drift_phase(-Phase::unbounded, Phase::unbounded);
  const State<double> x0{0.0, 0.5, 0.3, 1.5};
  const State<double> there = this->advance(loop, drift, 0.0, x0, 5.0).state;
  const State<double> reversed{there.q1, there.q2, -there.q1_dot, -there.q2_dot};
  const State<double> back = this->advance(loop, drift, 5.0, reversed, 10.0).state;
  EXPECT_LT(distance({back.q1, back.q2, -back.q1_dot, -back.q2_dot}, x0), 5.0 * error_growth * 1e-9);
}

TYPED_TEST_P(IntegratorMotion, TheErrorFallsWithTheTolerance) {
  const Oscillator oscillator{0.1, 2.0};
  const auto error = [&](double tolerance) {
    double sum = 0.0;
    for (const double start : {0.0, 0.13, 0.29, 0.41, 0.55, 0.68, 0.9, 1.2}) {
      const double end = start + 5.0;
      const Arrival arrival =
          this->advance(oscillator.loop(), align_phase(-1.0), start, this->state_of(oscillator, start), end, tolerance);
      sum += distance(arrival.state,
                      {oscillator.at(end)[0], arrival.state.q2, oscillator.at(end)[1], arrival.state.q2_dot});
    }
    return sum / 8.0;
  };
  const double coarse = error(1e-6);
  const double medium = error(1e-8);
  const double fine = error(1e-10);
  EXPECT_LT(coarse, error_growth * 1e-6);
  EXPECT_LT(medium, error_growth * 1e-8);
  EXPECT_LT(fine, error_growth * 1e-10);
  // A hundredth of the tolerance, a hundredth of the error, with a factor of 4 for steps that do not divide evenly;
  // over both hundredths, for an error thousands of times below the tolerance may be the rounding of a series instead.
  EXPECT_GT(coarse / fine, 25.0 * 25.0);
  EXPECT_GE(coarse, medium);
  EXPECT_GE(medium, fine);
}

TYPED_TEST_P(IntegratorMotion, StepsTouchAndTheirDenseOutputFollowsTheMotion) {
  const Oscillator oscillator{0.1, 2.0};
  const double tolerance = oscillator.active_error(oscillator.turning_point(2) - 0.03);
  for (const double t_end : {2.0, 6.0}) {  // by time and by the guard
    StepRecorder recorder;
    TypeParam integrator(1e-9);
    const Arrival arrival = integrator.advance(oscillator.loop(), align_phase(tolerance), 0.2,
                                               this->state_of(oscillator, 0.2), t_end, &recorder);
    ASSERT_FALSE(recorder.steps.empty());
    EXPECT_EQ(recorder.steps.front()[0], 0.2);
    EXPECT_EQ(recorder.steps.back()[1], arrival.t);
    for (std::size_t i = 1; i < recorder.steps.size(); ++i) {
      EXPECT_EQ(recorder.steps[i][0], recorder.steps[i - 1][1]);
      EXPECT_LT(recorder.steps[i][0], recorder.steps[i][1]);
    }
    for (const auto& [t, x] : recorder.samples) {
      EXPECT_NEAR(x.q1, oscillator.at(t)[0], error_growth * 1e-9) << t;
      EXPECT_NEAR(x.q1_dot, oscillator.at(t)[1], error_growth * 1e-9) << t;
    }
    EXPECT_LT(distance(recorder.samples.back().state, arrival.state), 1e-13);
  }
}

TYPED_TEST_P(IntegratorMotion, TheBitsDependOnTheArgumentsAlone) {
  ClosedLoop<double> loop = exact_loop();
  loop.plant = constants_of(PlantParameters<double>{1.1, 0.9, 0.5, 1.0, 0.02, 0.03});
  TypeParam fresh(1e-9);
  TypeParam used(1e-9);
  used.advance(loop, cycle_phase(150.0, 2.0), 0.0, {0.0, -0.7, 0.0, 0.0}, 2.0);
  used.advance(loop, drift_phase(0.3, 0.3), 2.0, {0.0, 0.3, 0.0, 0.0}, 3.0);  // two guards at zero throughout
  StepRecorder recorder;
  for (const Phase& phase :
       {drift_phase(-1.0, 0.4 + 1e-9), align_phase(1e-3), drift_phase(-1.0, 0.7), cycle_phase(40.0, 1.5)}) {
    const State<double> x0{0.5, 0.4, -0.2, 0.25};
    const Arrival once = fresh.advance(loop, phase, 11.0, x0, 12.5);
    const Arrival again = used.advance(loop, phase, 11.0, x0, 12.5);
    const Arrival watched = used.advance(loop, phase, 11.0, x0, 12.5, &recorder);
    EXPECT_EQ(bits_of(once), bits_of(again));
    EXPECT_EQ(bits_of(once), bits_of(watched));
  }
}

REGISTER_TYPED_TEST_SUITE_P(IntegratorMotion, AlignIsADampedOscillator, CycleMovesTheFirstJointAlongItsPolynomial,
                            AVeryShortCycleIsNoFailure, DriftOfAnExactPlantIsUniform,
                            AFreePlantKeepsItsEnergyAndItsMomentum, ADriftWithoutFrictionRunsBackToItsStart,
                            TheErrorFallsWithTheTolerance, StepsTouchAndTheirDenseOutputFollowsTheMotion,
                            TheBitsDependOnTheArgumentsAlone);

}  // namespace steerstat::testing
