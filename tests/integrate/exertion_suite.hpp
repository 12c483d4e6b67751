#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.hpp"
#include "integrate/exertion.hpp"
#include "integrator_fixture.hpp"

/// What a phase asks of the first joint: against closed forms, and against its own dense output sampled finely.
namespace steerstat::testing {

/// What is promised of effort and peaks, relative to them.
inline constexpr double exertion_precision = 1e-6;

/// The largest |f| on [0, t_end] and the integral of f^2, from samples so fine that their own error does not matter.
struct Sampled {
  double peak{0.0};
  double square{0.0};
};
template <class Function>
Sampled sampled(const Function& f, double t_end) {
  constexpr int intervals = 20000;
  Sampled result;
  double sum = 0.0;
  for (int i = 0; i <= intervals; ++i) {
    const double y = f(t_end * i / intervals);
    result.peak = std::max(result.peak, std::abs(y));
    sum += y * y * (i == 0 || i == intervals ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0));  // Simpson's rule
  }
  result.square = sum * t_end / (3.0 * intervals);
  return result;
}

/// Measures a phase on its dense output, by brute force.
class FineSampler final : public StepObserver {
 public:
  FineSampler(const ClosedLoop<double>& loop, const Phase& phase, double t0) : loop_(loop), phase_(phase), t0_(t0) {}

  void step(double from, double to, const DenseOutput& output) override {
    constexpr int intervals = 400;
    double sum = 0.0;
    for (int i = 0; i <= intervals; ++i) {
      const double t = from + (to - from) * i / intervals;
      const State<double> x = output.at(t);
      const double a = commanded_acceleration(loop_, phase_, t - t0_, x);
      const auto [s, c] = sincos(x.q2);
      const double tau = driving_force(loop_, a, x, s, c);
      exertion.peak_acceleration = std::max(exertion.peak_acceleration, std::abs(a));
      exertion.peak_force = std::max(exertion.peak_force, std::abs(tau));
      exertion.peak_stroke = std::max(exertion.peak_stroke, std::abs(x.q1 - loop_.q1_goal));
      sum += tau * tau * (i == 0 || i == intervals ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0));
    }
    exertion.effort += sum * (to - from) / (3.0 * intervals);
  }

  Exertion exertion;

 private:
  const ClosedLoop<double>& loop_;
  const Phase& phase_;
  double t0_;
};

inline void expect_near(const Exertion& measured, const Exertion& expected, double relative) {
  const auto near = [&](double x, double y, const char* what) { EXPECT_NEAR(x, y, relative * y) << what; };
  near(measured.effort, expected.effort, "effort");
  near(measured.peak_acceleration, expected.peak_acceleration, "peak acceleration");
  near(measured.peak_force, expected.peak_force, "peak force");
  near(measured.peak_stroke, expected.peak_stroke, "peak stroke");
}

template <class Integrator>
class IntegratorExertion : public IntegratorTest<Integrator> {
 protected:
  struct Measured {
    Arrival arrival;
    Exertion exertion;
  };
  static Measured measure(const ClosedLoop<double>& loop, const Phase& phase, double t0, const State<double>& x0,
                          double t_end) {
    Measured measured{{}, exertion_at(x0, loop.q1_goal)};
    measured.arrival = Integrator(1e-9).advance(loop, phase, t0, x0, t_end, nullptr, &measured.exertion);
    return measured;
  }
};

TYPED_TEST_SUITE_P(IntegratorExertion);

// With link 2 at rest on the first joint's axis, sin q2 = 0 and tau = (m1 + m2) a.
TYPED_TEST_P(IntegratorExertion, OfACycleIsThatOfItsPolynomial) {
  const double period = 1.7;
  const double amplitude = 30.0;
  for (const double fraction : {0.2, 0.6, 1.0}) {
    const double duration = fraction * period;
    const auto measured =
        this->measure(exact_loop(), cycle_phase(amplitude, period), 4.0, {0.0, 0.0, 0.0, 0.0}, 4.0 + duration);
    const Sampled a = sampled([&](double t) { return cycle_acceleration(amplitude, period, t); }, duration);
    const Sampled q1 = sampled([&](double t) { return cycle_motion(amplitude, period, t)[0]; }, duration);
    expect_near(measured.exertion, {4.0 * a.square, a.peak, 2.0 * a.peak, q1.peak}, 3e-8);
  }
}

TYPED_TEST_P(IntegratorExertion, OfAnAlignIsThatOfTheOscillatorUpToItsGuard) {
  for (const Oscillator& oscillator : {Oscillator{2.5, std::sqrt(0.75)}, Oscillator{0.1, 2.0}}) {
    for (const double tolerance : {1e-3, 0.4}) {
      const ClosedLoop<double> loop = oscillator.loop();
      const auto measured = this->measure(loop, align_phase(tolerance), 1.0, {1.0, 0.0, 0.0, 0.0}, 100.0);
      ASSERT_EQ(measured.arrival.cause, Cause::guard);
      const Sampled a = sampled(
          [&](double t) {
            const auto [e, v] = oscillator.at(t);
            return -loop.kp * e - loop.kd * v;
          },
          measured.arrival.t - 1.0);
      expect_near(measured.exertion, {4.0 * a.square, a.peak, 2.0 * a.peak, 1.0}, 1e-6);
    }
  }
}

// A controller that knows its plant holds the first joint while link 2 turns: tau = -m2 d2 cos(q2) q2_dot^2.
TYPED_TEST_P(IntegratorExertion, OfADriftIsTheForceThatHoldsTheTurningLink) {
  const double speed = 1.3;
  for (const double start : {-0.9, 0.4, 2.0}) {
    for (const double end : {start + 0.3, start + 5.0}) {
      const auto measured = this->measure(exact_loop(), drift_phase(-10.0, end), 0.0, {0.25, start, 0.0, speed}, 100.0);
      ASSERT_EQ(measured.arrival.cause, Cause::guard);
      const Sampled tau =
          sampled([&](double t) { return 0.5 * std::cos(start + speed * t) * speed * speed; }, (end - start) / speed);
      EXPECT_NEAR(measured.exertion.effort, tau.square, 1e-8 * tau.square);
      EXPECT_NEAR(measured.exertion.peak_force, tau.peak, 1e-8 * tau.peak);
      EXPECT_EQ(measured.exertion.peak_acceleration, 0.0);
      EXPECT_NEAR(measured.exertion.peak_stroke, 0.25, 1e-9);
    }
  }
}

TYPED_TEST_P(IntegratorExertion, IsThatOfTheDenseOutputSampledFinely) {
  PlantParameters<double> plant;
  plant.m1 = 1.17;
  plant.m2 = 0.84;
  plant.f1 = 0.04;
  plant.f2 = 0.02;
  ClosedLoop<double> loop = exact_loop();
  loop.plant = constants_of(plant);
  loop.q1_goal = 0.2;
  const State<double> x0{-0.6, 1.9, 0.3, 0.45};
  for (const Phase& phase : {align_phase(1e-3), cycle_phase(150.0, 2.0), cycle_phase(4.0, 9.0), drift_phase(-9.0, 5.0),
                             cycle_phase(0.3, 1.6e-3)}) {
    const double t_end = 2.0 + std::min(phase.duration, 40.0);
    const auto measured = this->measure(loop, phase, 2.0, x0, t_end);
    FineSampler sampler(loop, phase, 2.0);
    TypeParam(1e-9).advance(loop, phase, 2.0, x0, t_end, &sampler);
    expect_near(measured.exertion, sampler.exertion, exertion_precision);
  }
}

TYPED_TEST_P(IntegratorExertion, GoesOnFromWhatACourseHasAskedSoFar) {
  const Phase phase = cycle_phase(30.0, 1.7);
  const State<double> x0{0.0, 0.3, 0.0, 0.1};
  const auto alone = this->measure(exact_loop(), phase, 4.0, x0, 5.7);
  Exertion more{3.0, 100.0, 0.001, 100.0};
  TypeParam(1e-9).advance(exact_loop(), phase, 4.0, x0, 5.7, nullptr, &more);
  // How closely a step is looked at depends on what it may add.
  EXPECT_NEAR(more.effort, 3.0 + alone.exertion.effort, 1e-8 * more.effort);
  EXPECT_EQ(more.peak_acceleration, 100.0);
  EXPECT_NEAR(more.peak_force, alone.exertion.peak_force, 1e-8 * more.peak_force);
  EXPECT_EQ(more.peak_stroke, 100.0);
}

TYPED_TEST_P(IntegratorExertion, MeasuringItChangesNoBitOfTheMotion) {
  const State<double> x0{1.0, 0.3, 0.0, 0.1};
  for (const Phase& phase : {align_phase(1e-3), cycle_phase(30.0, 1.7), drift_phase(-1.0, 1.0)}) {
    const auto measured = this->measure(exact_loop(), phase, 0.0, x0, 5.0);
    EXPECT_EQ(bits_of(measured.arrival), bits_of(this->advance(exact_loop(), phase, 0.0, x0, 5.0)));
  }
}

REGISTER_TYPED_TEST_SUITE_P(IntegratorExertion, OfACycleIsThatOfItsPolynomial,
                            OfAnAlignIsThatOfTheOscillatorUpToItsGuard, OfADriftIsTheForceThatHoldsTheTurningLink,
                            IsThatOfTheDenseOutputSampledFinely, GoesOnFromWhatACourseHasAskedSoFar,
                            MeasuringItChangesNoBitOfTheMotion);

}  // namespace steerstat::testing
