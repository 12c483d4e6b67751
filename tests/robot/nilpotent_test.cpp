#include "robot/nilpotent.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "control/cycle.hpp"
#include "fields.hpp"
#include "runge_kutta.hpp"

namespace steerstat {
namespace {

using Real = long double;
using testing::cosine;
using testing::Dual;
using testing::integrated;
using testing::sine;

constexpr PolynomialCommand cycle(cycle_coefficients);

RegularPoint<Real> regular_point(Real q2, Real q2_dot) {
  return {0.2L, q2, q2_dot, sine(q2), cosine(q2), 0.4L};
}

const std::vector<RegularPoint<Real>> points{regular_point(0.4L, 0.3L), regular_point(2.1L, -0.5L),
                                             regular_point(-2.5L, 1.7L), regular_point(-0.9L, -0.2L)};

State<Real> state_of(const RegularPoint<Real>& x0) {
  return {x0.q1, x0.q2, 0.0L, x0.q2_dot};
}

std::array<Real, 4> values(const Privileged<Real>& z) {
  return {z.z1, z.z2, z.z3, z.z4};
}
constexpr std::array<int, 4> orders{1, 1, 2, 3};

/// |got - expected|, for GoogleTest, which compares doubles.
double gap(Real got, Real expected) {
  return static_cast<double>(std::abs(got - expected));
}

/// z with coordinate i multiplied by scale^order_i, the dilation under which (9) is homogeneous.
Privileged<Real> dilated(const Privileged<Real>& z, Real scale) {
  return {z.z1 * scale, z.z2 * scale, z.z3 * scale * scale, z.z4 * scale * scale * scale};
}

TEST(PrivilegedCoordinates, AreZeroAtTheRegularPoint) {
  for (const auto& x0 : points) {
    for (const Real z : values(privileged_coordinates(x0, state_of(x0)))) EXPECT_EQ(z, 0.0L);
  }
}

TEST(PrivilegedCoordinates, RoundTripThroughTheInverseFarFromTheRegularPoint) {
  for (const auto& x0 : points) {
    for (const State<Real>& x : {State<Real>{1.3L, -0.7L, 0.9L, 2.0L}, State<Real>{-2.0L, 4.0L, -1.1L, -0.3L}}) {
      const State<Real> back = state_at(x0, privileged_coordinates(x0, x));
      EXPECT_LE(gap(back.q1, x.q1), 1e-16);
      EXPECT_LE(gap(back.q2, x.q2), 1e-16);
      EXPECT_LE(gap(back.q1_dot, x.q1_dot), 1e-16);
      EXPECT_LE(gap(back.q2_dot, x.q2_dot), 1e-16);
    }
    const Privileged<Real> z{0.5L, -0.8L, 1.2L, 0.1L};
    const auto back = values(privileged_coordinates(x0, state_at(x0, z)));
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LE(gap(back[i], values(z)[i]), 1e-16);
  }
}

TEST(PrivilegedCoordinates, TheirDerivativesAtTheRegularPointInvertTheAccessibilityMatrix) {
  for (const auto& x0 : points) {
    const auto matrix = accessibility_matrix(x0);
    const RegularPoint<Dual<Real>> dual_point{{x0.q1, 0.0L}, {x0.q2, 0.0L}, {x0.q2_dot, 0.0L},
                                              {x0.s, 0.0L},  {x0.c, 0.0L},  {x0.coupling, 0.0L}};
    for (std::size_t k = 0; k < 4; ++k) {  // along column k, z must move by the unit vector k: (7)
      const State<Real> column{matrix[0][k], matrix[1][k], matrix[2][k], matrix[3][k]};
      const auto z = privileged_coordinates(dual_point, testing::along(state_of(x0), column));
      const std::array<Real, 4> slopes{z.z1.slope, z.z2.slope, z.z3.slope, z.z4.slope};
      for (std::size_t i = 0; i < 4; ++i) EXPECT_LE(gap(slopes[i], i == k ? 1.0L : 0.0L), 1e-17) << i << ',' << k;
    }
  }
}

/// z4 as a generic function of the state.
auto fourth_coordinate(const RegularPoint<Real>& x0) {
  return [x0]<class Number>(const State<Number>& x) {
    const auto constant = [](Real value) { return Number(static_cast<double>(value)); };
    const double q2 = static_cast<double>(x0.q2);
    const RegularPoint<Number> point{constant(x0.q1),      constant(x0.q2),      constant(x0.q2_dot),
                                     Number(std::sin(q2)), Number(std::cos(q2)), constant(x0.coupling)};
    return privileged_coordinates(point, x).z4;
  };
}

TEST(PrivilegedCoordinates, TheFourthHasOrderThree) {
  const PlantParameters<double> plant{};  // K = 0.4
  const auto f = testing::drift_of(plant);
  const auto g = testing::input_of(plant);
  using testing::derivative_along;
  for (const auto& x0 : points) {
    const State<double> x{static_cast<double>(x0.q1), static_cast<double>(x0.q2), 0.0, static_cast<double>(x0.q2_dot)};
    const auto z4 = fourth_coordinate(x0);
    const auto f4 = derivative_along(f, z4);
    const auto g4 = derivative_along(g, z4);
    EXPECT_NEAR(f4(x), 0.0, 1e-13);
    EXPECT_NEAR(g4(x), 0.0, 1e-13);
    EXPECT_NEAR(derivative_along(f, f4)(x), 0.0, 1e-13);
    EXPECT_NEAR(derivative_along(f, g4)(x), 0.0, 1e-13);
    EXPECT_NEAR(derivative_along(g, f4)(x), 0.0, 1e-13);
    EXPECT_NEAR(derivative_along(g, g4)(x), 0.0, 1e-13);
    EXPECT_GT(std::abs(derivative_along(g, derivative_along(f, g4))(x)), 1e-2);
  }
}

/// A state's rates under (5).
State<Real> rates_of(const State<Real>& x, Real a) {
  return {x.q1_dot, x.q2_dot, a, 0.4L * sine(x.q2) * a};
}

TEST(PrivilegedRates, AreTheChainRuleOnTheCoordinates) {
  for (const auto& x0 : points) {
    const RegularPoint<Dual<Real>> dual_point{{x0.q1, 0.0L}, {x0.q2, 0.0L}, {x0.q2_dot, 0.0L},
                                              {x0.s, 0.0L},  {x0.c, 0.0L},  {x0.coupling, 0.0L}};
    const State<Real> x{0.9L, 1.1L, -0.4L, 0.6L};
    for (const Real a : {0.0L, 1.0L, -2.5L}) {
      const auto z = privileged_coordinates(dual_point, testing::along(x, rates_of(x, a)));
      const Privileged<Real> rates = privileged_rates(x0, x, sine(x.q2), a);
      EXPECT_LE(gap(rates.z1, z.z1.slope), 1e-16);
      EXPECT_LE(gap(rates.z2, z.z2.slope), 1e-16);
      EXPECT_LE(gap(rates.z3, z.z3.slope), 1e-16);
      EXPECT_LE(gap(rates.z4, z.z4.slope), 1e-16);
    }
  }
}

/// |exact rate - approximate rate| of every coordinate at a dilated point.
std::array<Real, 4> field_errors(const RegularPoint<Real>& x0, Real scale) {
  const Privileged<Real> z = dilated({0.7L, -0.6L, 0.8L, 0.5L}, scale);
  const State<Real> x = state_at(x0, z);
  const auto exact = values(privileged_rates(x0, x, sine(x.q2), 1.3L));
  const auto approximate = values(nilpotent_rates(x0, z, 1.3L));
  std::array<Real, 4> errors{};
  for (std::size_t i = 0; i < 4; ++i) errors[i] = std::abs(exact[i] - approximate[i]);
  return errors;
}

TEST(NilpotentRates, KeepEveryTermBelowACoordinatesOrder) {
  // (9) keeps component i up to order omega_i - 1, so what it drops falls like scale^omega_i; in the first component
  // the linear terms cancel (the linear part of (5) is kept), so that it gains an order.
  for (const auto& x0 : points) {
    const auto coarse = field_errors(x0, 1e-3L);
    const auto fine = field_errors(x0, 0.5e-3L);
    EXPECT_EQ(fine[1], 0.0L);
    EXPECT_LE(gap(fine[2], 0.0L), 1e-22);
    EXPECT_LE(gap(std::log2(coarse[0] / fine[0]), orders[0] + 1), 0.02);
    EXPECT_LE(gap(std::log2(coarse[3] / fine[3]), orders[3]), 0.02);
  }
}

TEST(NilpotentRates, ThePrintedLastComponentLacksAFactorOfTheSpeed) {
  // With the printed q2_dot in place of q2_dot^2 the error falls with order 2, not 3: a term of order 2 is wrong.
  for (const auto& x0 : points) {
    const auto error = [&](Real scale) {
      const Privileged<Real> z = dilated({0.7L, -0.6L, 0.8L, 0.5L}, scale);
      const State<Real> x = state_at(x0, z);
      const Real printed = (-x0.q2_dot / (4.0L * x0.coupling * x0.c) * z.z1 * z.z1 - 0.5L * z.z3) * 1.3L;
      return std::abs(privileged_rates(x0, x, sine(x.q2), 1.3L).z4 - printed);
    };
    EXPECT_LE(gap(std::log2(error(1e-3L) / error(0.5e-3L)), 2.0L), 0.02);
  }
}

TEST(NilpotentResponse, IsTheSolutionOfTheApproximationAtAnyTime) {
  const Real amplitude = 3.0L;
  const Real period = 2.5L;
  for (const auto& x0 : points) {
    for (const Real t : {0.1L, 0.9L, 1.7L, 2.5L}) {
      const auto closed = values(nilpotent_response(x0, cycle, amplitude, period, t));
      const auto numeric = values(integrated<Privileged<Real>>({}, t, 4000, [&](const Privileged<Real>& z, Real time) {
        return nilpotent_rates(x0, z, cycle_acceleration(amplitude, period, time));
      }));
      for (std::size_t i = 0; i < 4; ++i) EXPECT_LE(gap(closed[i], numeric[i]), 1e-13) << "z" << i + 1 << " at " << t;
    }
  }
}

TEST(NilpotentResponse, AtTheEndOfACycleIsPeriodZeroZeroAndMinusBetaASquaredOverT) {
  for (const auto& x0 : points) {
    for (const Real amplitude : {1.0L, -4.0L, 50.0L}) {
      for (const Real period : {0.5L, 2.0L, 7.0L}) {
        const Privileged<Real> z = nilpotent_response(x0, cycle, amplitude, period, period);
        EXPECT_EQ(z.z1, period);
        EXPECT_LE(gap(z.z2, 0.0L), static_cast<double>(1e-14L * std::abs(amplitude) / period));
        EXPECT_LE(gap(z.z3, 0.0L), static_cast<double>(1e-14L * std::abs(amplitude)));
        const Real expected = -Real(beta) * amplitude * amplitude / period;
        EXPECT_LE(gap(z.z4, expected),
                  static_cast<double>(1e-10L * std::abs(expected) + 1e-13L * std::abs(amplitude) * period));
      }
    }
  }
}

TEST(NilpotentResponse, MapsBackToTheStateChangesOf12And13) {
  for (const auto& x0 : points) {
    const Real amplitude = 6.0L;
    const Real period = 1.5L;
    const State<Real> x = state_at(x0, nilpotent_response(x0, cycle, amplitude, period, period));
    EXPECT_LE(gap(x.q1, x0.q1), 1e-13);
    EXPECT_LE(gap(x.q1_dot, 0.0L), 1e-13);
    EXPECT_LE(gap(x.q2 - x0.q2, x0.q2_dot * period), 1e-13);  // (12)
    const Real change = -2.0L * x0.coupling * x0.coupling * x0.c * x0.s * Real(beta) * amplitude * amplitude / period;
    EXPECT_LE(gap(x.q2_dot - x0.q2_dot, change), 1e-13);  // (13)
  }
}

}  // namespace
}  // namespace steerstat
