#include <gtest/gtest.h>

#include <cmath>

#include "control/cycle.hpp"
#include "dual.hpp"
#include "robot/linearised.hpp"
#include "runge_kutta.hpp"

/// How far (12)-(13) are from what a cycle really does to (5).
namespace steerstat {
namespace {

using Real = long double;
using testing::cosine;
using testing::sine;

double gap(Real got, Real expected) {
  return static_cast<double>(std::abs(got - expected));
}

RegularPoint<Real> regular_point(Real q2, Real q2_dot) {
  return {0.2L, q2, q2_dot, sine(q2), cosine(q2), 0.4L};
}

/// The passive joint's change over one cycle of (5) from a regular point, to about 1e-17.
struct Change {
  Real q2;
  Real q2_dot;
};

Change change_over_cycle(const RegularPoint<Real>& x0, Real amplitude, Real period) {
  const State<Real> end = testing::integrated<State<Real>>(
      {x0.q1, x0.q2, 0.0L, x0.q2_dot}, period, 6000, [&](const State<Real>& x, Real t) {
        const Real a = cycle_acceleration(amplitude, period, t);
        return State<Real>{x.q1_dot, x.q2_dot, a, x0.coupling * sine(x.q2) * a};
      });
  return {end.q2 - x0.q2, end.q2_dot - x0.q2_dot};
}

Real predicted_speed_change(const RegularPoint<Real>& x0, Real amplitude, Real period) {  // (13)
  return -2.0L * x0.coupling * x0.coupling * x0.c * x0.s * Real(beta) * amplitude * amplitude / period;
}

TEST(Equations12And13, ErrOneOrderAboveTheCoordinateUnderShrinkingCycles) {
  // The approximation is homogeneous: with T ~ e and a ~ 1, so A ~ e^2, coordinate i is of order e^omega_i. (13) is
  // z4's, of order 3, and errs with order 4; (12) is z1's, of order 1, and errs with order 4 (2 is promised, but the
  // linear part of (5) is kept and the cycle's integrals vanish).
  for (const auto& x0 : {regular_point(0.4L, 0.3L), regular_point(2.1L, -0.5L), regular_point(-2.5L, 1.7L),
                         regular_point(-0.9L, -0.2L)}) {
    const auto errors = [&](Real scale) {
      const Real period = 0.4L * scale;
      const Real amplitude = 0.8L * scale * scale;
      const Change change = change_over_cycle(x0, amplitude, period);
      return Change{std::abs(change.q2 - x0.q2_dot * period),
                    std::abs(change.q2_dot - predicted_speed_change(x0, amplitude, period))};
    };
    const Change coarse = errors(1.0L / 8);
    const Change fine = errors(1.0L / 16);
    EXPECT_LE(gap(std::log2(coarse.q2 / fine.q2), 4.0L), 0.1);
    EXPECT_LE(gap(std::log2(coarse.q2_dot / fine.q2_dot), 4.0L), 0.1);
  }
}

TEST(Equations12And13, FromRestTheSpeedChangeErrsWithTheFourthPowerOfA) {
  // The order A^3 vanishes: the cycle is odd about its middle.
  for (const Real q2 : {0.4L, 2.1L, -2.5L, -0.9L}) {
    const RegularPoint<Real> x0 = regular_point(q2, 0.0L);
    const auto error = [&](Real amplitude) {
      return std::abs(change_over_cycle(x0, amplitude, 2.0L).q2_dot - predicted_speed_change(x0, amplitude, 2.0L));
    };
    EXPECT_LE(gap(std::log2(error(2.0L) / error(1.0L)), 4.0L), 0.04);
    EXPECT_LE(gap(std::log2(error(1.0L) / error(0.5L)), 4.0L), 0.02);
  }
}

TEST(Equations12And13, ThePositionChangeMissesHalfTheSpeedChangeTimesT) {
  // (12) takes the speed of the start for the whole cycle. What it leaves out is of order A^2, as large as what (13)
  // keeps: by the cycle's symmetry the speed changes, on average, half-way through.
  for (const Real q2 : {0.4L, 2.1L, -2.5L, -0.9L}) {
    const RegularPoint<Real> x0 = regular_point(q2, 0.0L);
    const Real period = 2.0L;
    const auto error = [&](Real amplitude) { return change_over_cycle(x0, amplitude, period).q2; };
    EXPECT_LE(gap(std::log2(error(2.0L) / error(1.0L)), 2.0L), 0.02);
    EXPECT_LE(gap(error(1.0L) / (predicted_speed_change(x0, 1.0L, period) * period / 2), 1.0L), 0.01);
  }
}

TEST(Equations12And13, WhileTheLinkTurnsTheSpeedChangeErrsLinearlyInA) {
  // To first order in A the change is K A / T times the integral of sin(q2 + theta lambda) p(lambda), theta the angle
  // turned. p has no moments below the third, which is -1/840: K A cos(q2) theta^3 / (5040 T) remains.
  const RegularPoint<Real> x0 = regular_point(0.4L, 0.05L);
  const Real period = 2.0L;
  const auto error = [&](Real amplitude) {
    return change_over_cycle(x0, amplitude, period).q2_dot - predicted_speed_change(x0, amplitude, period);
  };
  EXPECT_LE(gap(std::log2(error(2e-6L) / error(1e-6L)), 1.0L), 0.02);
  const Real theta = x0.q2_dot * period;
  EXPECT_LE(gap(error(1e-6L) / (x0.coupling * 1e-6L * x0.c * theta * theta * theta / (5040 * period)), 1.0L), 0.03);
}

}  // namespace
}  // namespace steerstat
