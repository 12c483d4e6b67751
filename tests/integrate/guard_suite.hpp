#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "integrator_fixture.hpp"

/// Closed loops whose guards fire at known times.
namespace steerstat::testing {

template <class Integrator>
class IntegratorGuards : public IntegratorTest<Integrator> {};

TYPED_TEST_SUITE_P(IntegratorGuards);

TYPED_TEST_P(IntegratorGuards, AlignEndsAtItsToleranceAtTheKnownTime) {
  for (const double rate : {2.0, 3.0}) {  // the eigenvalues of kp = 6, kd = 5
    const double start_error = std::sqrt(1.0 + rate * rate);
    const double expected = 7.0 + std::log(start_error / 1e-3) / rate;
    const Arrival arrival =
        this->advance(exact_loop(6.0, 5.0), align_phase(1e-3), 7.0, {-1.0, 0.7, rate, 0.1}, 100.0, 1e-12);
    ASSERT_EQ(arrival.cause, Cause::guard);
    EXPECT_NEAR(arrival.t, expected, guard_precision + error_growth * 1e-12 / (rate * 1e-3));
  }
}

TYPED_TEST_P(IntegratorGuards, TheGuardsFunctionIsZeroWhereItFired) {
  const ClosedLoop<double> loop = exact_loop();
  for (const double tolerance : {1e-3, 0.02, 0.3}) {
    const Phase align = align_phase(tolerance);
    const Arrival arrival = this->advance(loop, align, 100.0, {1.0, 0.7, 0.0, 0.1}, 300.0);
    ASSERT_EQ(arrival.cause, Cause::guard);
    const double speed = 10.0 * tolerance;  // bounds |d active error / dt| <= sqrt(v^2 + a^2) at that error
    EXPECT_NEAR(guards(loop, align, arrival.state)[0], 0.0, speed * guard_precision + 1e-15);
  }
}

TYPED_TEST_P(IntegratorGuards, DriftEndsAtEitherBoundAtTheKnownTime) {
  for (const double speed : {0.3, -0.3}) {
    const Arrival arrival = this->advance(exact_loop(), drift_phase(-2.0, 1.0), 5.0, {0.0, -0.5, 0.0, speed}, 300.0);
    ASSERT_EQ(arrival.cause, Cause::guard);
    EXPECT_NEAR(arrival.t, 5.0 + 1.5 / 0.3, guard_precision);
    EXPECT_NEAR(arrival.state.q2, speed > 0.0 ? 1.0 : -2.0, 0.3 * guard_precision);
  }
}

TYPED_TEST_P(IntegratorGuards, FrictionBringsADriftToItsFloorAtTheKnownTimeAndAngle) {
  // Link 2 on its axis: no coupling, so q2_dot decays at the rate f2 / I2.
  const PlantParameters<double> plant{1.0, 1.0, 1e-12, 1.0, 0.0, 0.05};
  const double floor = 1e-3;
  for (const double direction : {1.0, -1.0}) {
    Phase phase = drift_phase(-100.0, 100.0);
    phase.direction = direction;
    phase.speed_floor = floor;
    const Arrival arrival = this->advance(free_loop(plant), phase, 0.0, {0.0, 0.2, 0.0, 0.1 * direction}, 300.0);
    ASSERT_EQ(arrival.cause, Cause::guard);
    const double slope = 0.05 * floor;
    EXPECT_NEAR(arrival.t, std::log(0.1 / floor) / 0.05, guard_precision + error_growth * 1e-9 / slope);
    EXPECT_NEAR(arrival.state.q2, 0.2 + direction * (0.1 - floor) / 0.05, error_growth * error_growth * 1e-9);
    EXPECT_NEAR(arrival.state.q2_dot, direction * floor, 1e-14);
  }
}

TYPED_TEST_P(IntegratorGuards, TheFirstOfSeveralGuardsEndsThePhase) {
  Phase phase = drift_phase(-2.0, 1.0);
  phase.speed_floor = 0.05;
  const PlantParameters<double> plant{1.0, 1.0, 1e-12, 1.0, 0.0, 0.05};  // from 0.1 the floor comes 1 rad on
  const Arrival angle = this->advance(free_loop(plant), phase, 0.0, {0.0, 0.01, 0.0, 0.1}, 300.0);
  EXPECT_NEAR(angle.state.q2, 1.0, 1e-9);
  EXPECT_GT(angle.state.q2_dot, 0.0503);
  const Arrival floor = this->advance(free_loop(plant), phase, 0.0, {0.0, -0.01, 0.0, 0.1}, 300.0);
  EXPECT_NEAR(floor.state.q2_dot, 0.05, 1e-9);
  EXPECT_LT(floor.state.q2, 0.991);
}

TYPED_TEST_P(IntegratorGuards, AShortDipFiresAtItsFirstCrossing) {
  const Oscillator oscillator{0.1, 2.0};
  const double t_end = 6.0;
  for (const double width : {0.01, 0.03, 0.06, 0.09}) {
    for (const int dip : {1, 2, 3}) {
      const double crossing = oscillator.turning_point(dip) - 0.5 * width;
      const double tolerance = oscillator.active_error(crossing);
      const auto guard = [&](double t) { return oscillator.active_error(t) - tolerance; };
      ASSERT_GT(guard(crossing + 1.2 * width), 0.0) << "it comes back";
      for (double start = 0.05; start < 1.0; start += 0.05) {
        ASSERT_NEAR(first_descent_by_samples(guard, start, t_end, 1e-3), crossing, 1e-9) << "it is the first dip";
        const Arrival arrival =
            this->advance(oscillator.loop(), align_phase(tolerance), start, this->state_of(oscillator, start), t_end);
        ASSERT_EQ(arrival.cause, Cause::guard) << width << ' ' << dip << ' ' << start;
        const double slope = (guard(crossing - 1e-4) - guard(crossing + 1e-4)) / 2e-4;
        EXPECT_NEAR(arrival.t, crossing, guard_precision + error_growth * 1e-9 / slope) << width << ' ' << start;
      }
    }
  }
}

TYPED_TEST_P(IntegratorGuards, ADipFiresWhereItReachesTheToleranceAndNotWhereItJustMisses) {
  const Oscillator oscillator{0.1, 2.0};
  for (const int dip : {1, 2}) {
    const double lowest = oscillator.active_error(oscillator.turning_point(dip));
    const double t_end = oscillator.turning_point(dip) + 0.3;
    for (double start = 0.05; start < 1.0; start += 0.05) {
      const State<double> x0 = this->state_of(oscillator, start);
      const Arrival miss = this->advance(oscillator.loop(), align_phase(lowest * (1.0 - 1e-6)), start, x0, t_end);
      EXPECT_EQ(miss.cause, Cause::time) << start;
      EXPECT_EQ(miss.t, t_end);
      const Arrival touch = this->advance(oscillator.loop(), align_phase(lowest * (1.0 + 1e-6)), start, x0, t_end);
      EXPECT_EQ(touch.cause, Cause::guard) << start;
      EXPECT_NEAR(touch.t, oscillator.turning_point(dip), 2e-3);
    }
  }
}

TYPED_TEST_P(IntegratorGuards, AGuardThatStartsNonPositiveWaitsUntilItHasBeenPositive) {
  const Oscillator oscillator{0.1, 2.0};
  // The active error rises from 1 to nearly 2, and dips below 1 once in a half turn from then on.
  const double start = 0.2;
  const State<double> x0 = this->state_of(oscillator, start);
  const double at_zero = guards(oscillator.loop(), align_phase(0.0), x0)[0];
  for (const double tolerance : {at_zero, std::nextafter(at_zero, 2.0), 1.2 * at_zero, 1.5 * at_zero}) {
    const auto guard = [&](double t) { return oscillator.active_error(t) - tolerance; };
    const double expected = first_descent_by_samples(guard, start + 1e-6, 5.0, 1e-3);
    ASSERT_GT(expected, start + 0.5);
    const Arrival arrival = this->advance(oscillator.loop(), align_phase(tolerance), start, x0, 5.0);
    ASSERT_EQ(arrival.cause, Cause::guard) << tolerance;
    EXPECT_NEAR(arrival.t, expected, guard_precision + error_growth * 1e-9) << tolerance;
  }
}

TYPED_TEST_P(IntegratorGuards, AGuardThatStartsOneBitAboveZeroAndFallsFiresAtOnce) {
  const State<double> x0{-1.0, 0.7, 2.0, 0.1};  // on an eigenvector of kp = 6, kd = 5
  const double tolerance = std::nextafter(guards(exact_loop(6.0, 5.0), align_phase(0.0), x0)[0], 0.0);
  const Arrival arrival = this->advance(exact_loop(6.0, 5.0), align_phase(tolerance), 3.0, x0, 300.0);
  ASSERT_EQ(arrival.cause, Cause::guard);
  EXPECT_NEAR(arrival.t, 3.0, guard_precision);
}

TYPED_TEST_P(IntegratorGuards, AGuardThatNeverBecomesPositiveNeverFires) {
  const State<double> x0{0.0, 0.5, 0.0, 0.1};
  for (const double high : {0.5, std::nextafter(0.5, 0.0), 0.2}) {  // at or behind the start, and moving on
    const Arrival arrival = this->advance(exact_loop(), drift_phase(-10.0, high), 0.0, x0, 20.0);
    EXPECT_EQ(arrival.cause, Cause::time) << high;
    EXPECT_EQ(arrival.t, 20.0);
  }
  for (const double low : {0.5, 0.6, 1.0}) {  // non-positive first, positive from then on
    const Arrival arrival = this->advance(exact_loop(), drift_phase(low, 10.0), 0.0, x0, 20.0);
    EXPECT_EQ(arrival.cause, Cause::time) << low;
  }
}

TYPED_TEST_P(IntegratorGuards, AGuardAtTheEndOfTheIntervalFiresNoLater) {
  const State<double> x0{0.0, 0.0, 0.0, 0.5};
  const Arrival at_end = this->advance(exact_loop(), drift_phase(-10.0, 1.0), 0.0, x0, 2.0);
  EXPECT_NEAR(at_end.t, 2.0, guard_precision);
  EXPECT_LE(at_end.t, 2.0);
  EXPECT_NEAR(at_end.state.q2, 1.0, guard_precision);
  const Arrival before = this->advance(exact_loop(), drift_phase(-10.0, 1.0 - 1e-8), 0.0, x0, 2.0);
  EXPECT_EQ(before.cause, Cause::guard);
  EXPECT_NEAR(before.t, 2.0 - 2e-8, guard_precision);
  const Arrival after = this->advance(exact_loop(), drift_phase(-10.0, 1.0 + 1e-8), 0.0, x0, 2.0);
  EXPECT_EQ(after.cause, Cause::time);
  EXPECT_EQ(after.t, 2.0);
}

TYPED_TEST_P(IntegratorGuards, AlignEndsWhereItsAccelerationComesToTheCeilingAtTheKnownTime) {
  // kp = 6 and kd = 5 at a pace of 2 from 1.5 and 2.5: from (5, -6), a = -36 (exp(-2 t) - exp(-3 t)).
  const ClosedLoop<double> loop = exact_loop(1.5, 2.5);
  const auto magnitude = [](double t) { return 36.0 * (std::exp(-2.0 * t) - std::exp(-3.0 * t)); };
  for (const double sign : {1.0, -1.0}) {
    const State<double> x0{sign * 5.0, 0.7, sign * -6.0, 0.1};
    Phase phase = align_phase(1e-3);
    phase.pace = 2.0;
    for (const double t : {0.01, 0.2, 0.4}) {
      phase.ceiling = magnitude(t);
      const Arrival arrival = this->advance(loop, phase, 3.0, x0, 300.0);
      ASSERT_EQ(arrival.cause, Cause::guard);
      const double slope = (magnitude(t + 1e-4) - magnitude(t - 1e-4)) / 2e-4;
      EXPECT_NEAR(arrival.t, 3.0 + t, guard_precision + error_growth * 1e-9 / slope);
      EXPECT_NEAR(guards(loop, phase, arrival.state)[4], 0.0, 1e-8);
    }
  }
}

TYPED_TEST_P(IntegratorGuards, ACeilingThatTheAccelerationJustMissesEndsNothing) {
  const ClosedLoop<double> loop = exact_loop(6.0, 5.0);
  const State<double> x0{5.0, 0.7, -6.0, 0.1};
  Phase phase = align_phase(1e-3);
  const double highest = 36.0 * 4.0 / 27.0;  // at exp(t) = 3/2
  const Arrival free = this->advance(loop, phase, 3.0, x0, 300.0);
  phase.ceiling = highest * (1.0 + 1e-7);
  EXPECT_EQ(bits_of(this->advance(loop, phase, 3.0, x0, 300.0)), bits_of(free));
  phase.ceiling = highest * (1.0 - 1e-7);
  EXPECT_NEAR(this->advance(loop, phase, 3.0, x0, 300.0).t, 3.0 + std::log(1.5), 1e-3);
}

TYPED_TEST_P(IntegratorGuards, ACeilingIsMetOnTheWayUpThoughTheWayDownIsNextToWhereTheSearchLooks) {
  const ClosedLoop<double> loop = exact_loop(6.0, 5.0);
  const auto magnitude = [](double t) { return 36.0 * (std::exp(-2.0 * t) - std::exp(-3.0 * t)); };
  const double top = std::log(1.5);
  int cases = 0;
  for (double start = 0.0; start < 0.3; start += 0.02) {
    const double first = std::exp(-2.0 * start), second = std::exp(-3.0 * start);
    const State<double> x0{9.0 * first - 4.0 * second, 0.7, 12.0 * second - 18.0 * first, 0.1};
    Phase phase = align_phase(1e-3);
    StepRecorder free;
    TypeParam(1e-9).advance(loop, phase, start, x0, 2.0, &free);
    for (const auto& [from, to] : free.steps) {
      if (!(from < top && top < to)) continue;
      const double part = (to - from) / 16.0;  // as finely as the lockstep search looks first
      const double end = from + part * (std::floor((top - from) / part) + 1.0);
      phase.ceiling = magnitude(end + 1e-4 * part);
      if (end - top > 0.4 * part || magnitude(top) - phase.ceiling < 1e-8) continue;
      const auto below = [&](double t) { return phase.ceiling - magnitude(t); };
      const double expected = first_descent_by_samples(below, end - part, top, 0.01 * part);
      const double slope = (magnitude(expected + 1e-5) - magnitude(expected - 1e-5)) / 2e-5;
      const Arrival arrival = this->advance(loop, phase, start, x0, 2.0);
      ASSERT_EQ(arrival.cause, Cause::guard);
      EXPECT_NEAR(arrival.t, expected, guard_precision + error_growth * 1e-9 / slope) << start;
      ++cases;
    }
  }
  EXPECT_GT(cases, 0);
}

REGISTER_TYPED_TEST_SUITE_P(IntegratorGuards, AlignEndsAtItsToleranceAtTheKnownTime,
                            TheGuardsFunctionIsZeroWhereItFired, DriftEndsAtEitherBoundAtTheKnownTime,
                            FrictionBringsADriftToItsFloorAtTheKnownTimeAndAngle, TheFirstOfSeveralGuardsEndsThePhase,
                            AShortDipFiresAtItsFirstCrossing,
                            ADipFiresWhereItReachesTheToleranceAndNotWhereItJustMisses,
                            AGuardThatStartsNonPositiveWaitsUntilItHasBeenPositive,
                            AGuardThatStartsOneBitAboveZeroAndFallsFiresAtOnce,
                            AGuardThatNeverBecomesPositiveNeverFires, AGuardAtTheEndOfTheIntervalFiresNoLater,
                            AlignEndsWhereItsAccelerationComesToTheCeilingAtTheKnownTime,
                            ACeilingThatTheAccelerationJustMissesEndsNothing,
                            ACeilingIsMetOnTheWayUpThoughTheWayDownIsNextToWhereTheSearchLooks);

}  // namespace steerstat::testing
