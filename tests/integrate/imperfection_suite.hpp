#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "integrator_fixture.hpp"

/// Closed loops with imperfections whose motion is known (engine/robot/README.md).
namespace steerstat::testing {

/// A damped oscillator y'' = -kp y - kd y' with kd^2 < 4 kp, from any start: y and y' after t.
inline std::array<double, 2> oscillation(double kp, double kd, double y0, double v0, double t) {
  const double decay = 0.5 * kd;
  const double frequency = std::sqrt(kp - decay * decay);
  const double b = (v0 + decay * y0) / frequency;
  const double c = std::cos(frequency * t);
  const double s = std::sin(frequency * t);
  const double envelope = std::exp(-decay * t);
  return {envelope * (y0 * c + b * s),
          envelope * ((b * frequency - decay * y0) * c - (y0 * frequency + decay * b) * s)};
}

/// Where a mass that Coulomb friction slows by `level` [m/s^2] has the speed v: t = (F(v0) - F(v)) / level. From
/// dv/dt = -level v / sqrt(v^2 + vs^2).
inline double sliding_time(double v, double smoothing) {
  return std::sqrt(v * v + smoothing * smoothing) - smoothing * std::asinh(smoothing / v);
}

template <class Integrator>
class IntegratorImperfections : public IntegratorTest<Integrator> {
 protected:
  static Phase endless() { return drift_phase(-Phase::unbounded, Phase::unbounded); }
};

TYPED_TEST_SUITE_P(IntegratorImperfections);

TYPED_TEST_P(IntegratorImperfections, ATiltAlongTheFirstAxisAddsAParabolaToAnyFreeMotion) {
  const ClosedLoop<double> flat = free_loop({1.2, 0.8, 0.7, 0.3, 0.0, 0.0});
  ClosedLoop<double> tilted = flat;
  tilted.disturbance.gravity_x = 0.3;
  const State<double> x0{0.1, 0.5, 0.2, 1.5};
  for (const double t : {0.4, 3.0, 8.0}) {
    State<double> expected = this->advance(flat, this->endless(), 0.0, x0, t).state;
    expected.q1 += 0.5 * 0.3 * t * t;
    expected.q1_dot += 0.3 * t;
    EXPECT_LT(distance(this->advance(tilted, this->endless(), 0.0, x0, t).state, expected), 2 * error_growth * 1e-9);
  }
}

TYPED_TEST_P(IntegratorImperfections, AFreeTiltedRobotKeepsItsEnergy) {
  ClosedLoop<double> loop = free_loop({1.2, 0.8, -0.7, 0.3, 0.0, 0.0});
  loop.disturbance.gravity_x = -0.2;
  loop.disturbance.gravity_y = 0.9;
  const auto energy = [&](const State<double>& x) {
    const double s = std::sin(x.q2);
    return kinetic_energy(loop.plant, x, s) + potential_energy(loop.plant, loop.disturbance, x, s, std::cos(x.q2));
  };
  const State<double> x0{0.1, 0.5, 0.2, -0.3};
  const State<double> x1 = this->advance(loop, this->endless(), 0.0, x0, 9.0).state;
  EXPECT_GT(std::abs(kinetic_energy(loop.plant, x1, std::sin(x1.q2)) - kinetic_energy(loop.plant, x0, std::sin(x0.q2))),
            0.1);
  EXPECT_NEAR(energy(x1), energy(x0), error_growth * 1e-9 * 3.0);
}

TYPED_TEST_P(IntegratorImperfections, ASlidingMassStopsAsCoulombFrictionSays) {
  ClosedLoop<double> loop = free_loop({1.5, 0.5, 0.5, 1.0, 0.0, 0.0});
  loop.disturbance.coulomb1 = 0.8;  // of 2 kg: 0.4 m/s^2
  const double level = 0.4;
  const double v0 = -0.6;
  for (const double smoothing : {1e-2, 1e-3, 1e-4}) {
    loop.disturbance.coulomb_speed1 = smoothing;
    const State<double> x0{0.3, 0.0, v0, 0.0};  // link 2 stretched and at rest stays so
    for (const double t : {0.5, 1.4, 1.52}) {
      const State<double> x = this->advance(loop, this->endless(), 0.0, x0, t).state;
      EXPECT_EQ(x.q2_dot, 0.0);
      const double v = -x.q1_dot;
      if (t > 1.5 && smoothing < 1e-2) continue;  // at rest but for rounding
      const double spent = sliding_time(-v0, smoothing) - sliding_time(v, smoothing);
      EXPECT_NEAR(spent, level * t, error_growth * 1e-9 * (1.0 + smoothing / v)) << smoothing << " at " << t;
    }
    const State<double> stopped = this->advance(loop, this->endless(), 0.0, x0, 4.0).state;
    EXPECT_NEAR(stopped.q1_dot, 0.0, error_growth * 1e-9);
    // The integral of v dt is that of sqrt(v^2 + smoothing^2) dv / level.
    const double way =
        0.5 / level *
        (-v0 * std::sqrt(v0 * v0 + smoothing * smoothing) + smoothing * smoothing * std::asinh(-v0 / smoothing));
    EXPECT_NEAR(stopped.q1, 0.3 - way, 2 * error_growth * 1e-9);
    EXPECT_NEAR(stopped.q1, 0.3 - v0 * v0 / (2.0 * level), 0.1 * smoothing) << "nearly that of dry friction";
  }
}

TYPED_TEST_P(IntegratorImperfections, ASpinningLinkStopsAsCoulombFrictionSays) {
  // Link 2 on its axis: nothing moves the first joint.
  ClosedLoop<double> loop = free_loop({1.0, 1.0, 1e-12, 1.0, 0.0, 0.0});
  loop.disturbance.coulomb2 = 0.03;
  loop.disturbance.coulomb_speed2 = 2e-3;
  for (const double t : {1.0, 9.0, 10.2}) {
    const State<double> x = this->advance(loop, this->endless(), 0.0, {0.0, 1.0, 0.0, 0.3}, t).state;
    EXPECT_NEAR(sliding_time(0.3, 2e-3) - sliding_time(x.q2_dot, 2e-3), 0.03 * t, error_growth * 1e-9) << t;
  }
}

TYPED_TEST_P(IntegratorImperfections, FrictionThatChangesItsSignIsCrossedWithoutLoss) {
  // Aligning reverses a joint that rubs weakly: a step that took its friction for constant would miss the reversal.
  ClosedLoop<double> loop = exact_loop();
  loop.disturbance.coulomb1 = 1e-3;
  loop.disturbance.coulomb_speed1 = 1e-4;
  const State<double> x0{0.5, 0.0, 3.0, 0.0};
  const State<double> coarse = this->advance(loop, align_phase(-1.0), 0.0, x0, 2.0, 1e-9).state;
  const State<double> fine = this->advance(loop, align_phase(-1.0), 0.0, x0, 2.0, 1e-12).state;
  EXPECT_LT(distance(coarse, fine), error_growth * 1e-9);
}

TYPED_TEST_P(IntegratorImperfections, AGainErrorScalesTheLaw) {
  ClosedLoop<double> loop = exact_loop(7.0, 2.0);
  loop.actuator.gain = 1.25;
  for (const double t : {0.3, 2.0}) {
    const State<double> x = this->advance(loop, align_phase(-1.0), 0.0, {1.0, 0.0, 0.0, 0.0}, t).state;
    const auto [e, v] = oscillation(1.25 * 7.0, 1.25 * 2.0, 1.0, 0.0, t);
    EXPECT_NEAR(x.q1, e, error_growth * 1e-9);
    EXPECT_NEAR(x.q1_dot, v, error_growth * 1e-9);
  }
}

TYPED_TEST_P(IntegratorImperfections, ALimitedAlignIsBangThenLaw) {
  ClosedLoop<double> loop = exact_loop(7.0, 2.0);
  for (const double force : {0.5, 4.0, 13.9, 14.1}) {  // of 2 kg; the law starts with 14 N
    loop.actuator.max_force = force;
    const double a = 0.5 * force;
    // q1 = 1 - a t^2 / 2 and q1_dot = -a t, while 7 q1 + 2 q1_dot > a.
    const double b = 2.0 * a;
    const double released = force >= 14.0 ? 0.0 : (std::sqrt(b * b + 14.0 * a * (7.0 - a)) - b) / (7.0 * a);
    const State<double> x0{1.0, 0.0, 0.0, 0.0};
    for (const double t : {0.5 * released, released, released + 0.05}) {
      if (t == 0.0) continue;
      double e = 1.0 - 0.5 * a * t * t;
      double v = -a * t;
      if (t > released) {
        const double e0 = 1.0 - 0.5 * a * released * released;
        const auto after = oscillation(7.0, 2.0, e0, -a * released, t - released);
        e = after[0];
        v = after[1];
      }
      const State<double> x = this->advance(loop, align_phase(-1.0), 0.0, x0, t).state;
      EXPECT_NEAR(x.q1, e, error_growth * 1e-9) << force << " N at " << t;
      EXPECT_NEAR(x.q1_dot, v, error_growth * 1e-9) << force << " N at " << t;
    }
  }
}

TYPED_TEST_P(IntegratorImperfections, AGuardFiresAtTheLimitToo) {
  ClosedLoop<double> loop = exact_loop();
  loop.actuator.max_force = 0.1;
  const Arrival arrival = this->advance(loop, align_phase(1.0), 0.0, {3.0, 0.0, 0.0, 0.0}, 30.0);
  ASSERT_EQ(arrival.cause, Cause::guard);
  const auto distance_at = [](double t) {
    const double e = 3.0 - 0.025 * t * t;
    return std::sqrt(e * e + 0.0025 * t * t) - 1.0;
  };
  EXPECT_NEAR(arrival.t, first_descent_by_samples(distance_at, 0.0, 20.0, 1e-3), 1e-7);
}

TYPED_TEST_P(IntegratorImperfections, ABiasedAlignGoesToItsShiftedGoalAndEndsWhereItReadsSo) {
  const ClosedLoop<double> loop = exact_loop(7.0, 2.0);
  Phase phase = align_phase(0.02);
  phase.q1_offset = 0.3;
  phase.q1_dot_offset = -0.01;
  const double shift = 0.3 + 2.0 * -0.01 / 7.0;
  const auto at = [&](double t) { return oscillation(7.0, 2.0, 1.0 + shift, 0.4, t); };
  const auto read_error = [&](double t) {
    const auto [y, v] = at(t);
    const double e = y - shift + 0.3;
    return std::sqrt(e * e + (v - 0.01) * (v - 0.01)) - 0.02;
  };
  const double expected = first_descent_by_samples(read_error, 0.0, 20.0, 1e-4);
  ASSERT_LT(expected, 20.0);
  const Arrival arrival = this->advance(loop, phase, 0.0, {1.0, 0.0, 0.4, 0.0}, 20.0);
  ASSERT_EQ(arrival.cause, Cause::guard);
  EXPECT_NEAR(arrival.t, expected, 1e-7);
  const auto [y, v] = at(arrival.t);
  EXPECT_NEAR(arrival.state.q1, y - shift, error_growth * 1e-9);
  EXPECT_NEAR(arrival.state.q1_dot, v, error_growth * 1e-9);
}

TYPED_TEST_P(IntegratorImperfections, TheCeilingIsOnTheAccelerationThatIsReadToBeNeeded) {
  const ClosedLoop<double> loop = exact_loop(7.0, 0.5);
  for (const double offset : {-0.4, 0.4}) {
    Phase phase = align_phase(0.02);
    phase.q1_offset = 0.3;
    phase.q1_dot_offset = offset;
    const double shift = 0.3 + 0.5 * offset / 7.0;
    const auto read = [&](double t) {
      const auto [y, v] = oscillation(7.0, 0.5, shift, 1.0, t);
      return -7.0 * y - 0.5 * v;  // y has the velocity's offset in it
    };
    phase.ceiling = 2.9;
    const double expected = first_descent_by_samples([&](double t) { return 2.9 - std::abs(read(t)); }, 0.0, 5.0, 1e-4);
    ASSERT_LT(expected, 5.0) << offset;
    const Arrival arrival = this->advance(loop, phase, 0.0, {0.0, 0.0, 1.0, 0.0}, 20.0);
    ASSERT_EQ(arrival.cause, Cause::guard);
    EXPECT_NEAR(arrival.t, expected, 1e-7);
    EXPECT_NEAR(std::abs(align_acceleration(loop, phase, arrival.state)), 2.9, 1e-8);
  }
}

REGISTER_TYPED_TEST_SUITE_P(IntegratorImperfections, ATiltAlongTheFirstAxisAddsAParabolaToAnyFreeMotion,
                            AFreeTiltedRobotKeepsItsEnergy, ASlidingMassStopsAsCoulombFrictionSays,
                            ASpinningLinkStopsAsCoulombFrictionSays, FrictionThatChangesItsSignIsCrossedWithoutLoss,
                            AGainErrorScalesTheLaw, ALimitedAlignIsBangThenLaw, AGuardFiresAtTheLimitToo,
                            ABiasedAlignGoesToItsShiftedGoalAndEndsWhereItReadsSo,
                            TheCeilingIsOnTheAccelerationThatIsReadToBeNeeded);

}  // namespace steerstat::testing
