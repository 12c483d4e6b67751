#include "control/goal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace steerstat {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Quadrant {
  double lower;  ///< [rad] bound
  double sigma;
};

constexpr Quadrant quadrants[] = {{0.0, 1.0}, {pi / 2, -1.0}, {-pi, 1.0}, {-pi / 2, -1.0}};

TEST(Goal, ApproachesFromTheLowerBoundInQuadrants1And3AndFromTheUpperIn2And4) {
  for (const auto& [lower, sigma] : quadrants) {
    for (const double inside : {0.01, 0.5, 1.2, pi / 2 - 0.01}) {
      const Goal goal = goal_at(0.3, lower + inside);
      EXPECT_EQ(goal.q1, 0.3);
      EXPECT_EQ(goal.q2, lower + inside);
      EXPECT_EQ(goal.sigma, sigma) << lower + inside;
      EXPECT_NEAR(goal.edge, sigma > 0 ? lower : lower + pi / 2, 1e-15);
      EXPECT_NEAR(goal.width, sigma > 0 ? inside : pi / 2 - inside, 1e-15);
    }
  }
}

TEST(Goal, SigmaIsTheSignOfSin2Q2OnAnyTurn) {
  for (double q2 = -40.0; q2 < 40.0; q2 += 0.0371) {
    const double sine = std::sin(2.0 * q2);
    if (std::abs(sine) < 1e-9) continue;
    const Goal goal = goal_at(0.0, q2);
    EXPECT_EQ(goal.sigma, sine > 0.0 ? 1.0 : -1.0) << q2;
    EXPECT_GT(goal.width, 0.0);
    EXPECT_LT(goal.width, pi / 2);
    // The approach moves with sigma from the edge to the goal.
    EXPECT_NEAR(goal.edge + goal.sigma * goal.width, q2, 1e-14 * std::max(1.0, std::abs(q2)));
  }
}

TEST(Goal, QuadrantChangesAtTheQuarterTurn) {
  EXPECT_EQ(goal_at(0.0, std::nextafter(pi / 2, 0.0)).sigma, 1.0);
  EXPECT_EQ(goal_at(0.0, pi / 2).sigma, -1.0);
  EXPECT_EQ(goal_at(0.0, -1e-9).sigma, -1.0);
  EXPECT_EQ(goal_at(0.0, 0.0).sigma, 1.0);
}

TEST(Goal, MirroredGoalHasTheMirroredGeometry) {
  for (const double q2 : {0.2, 0.8, 1.9, 2.9, 4.0, 5.5}) {
    const Goal here = goal_at(0.0, q2);
    const Goal there = goal_at(0.0, -q2);
    EXPECT_EQ(there.sigma, -here.sigma);
    EXPECT_EQ(there.edge, -here.edge);
    EXPECT_EQ(there.width, here.width);
  }
}

TEST(Goal, HalfATurnKeepsSigmaAndWidth) {
  for (const double q2 : {-2.0, -0.7, 0.2, 0.8, 1.9, 2.9}) {
    EXPECT_EQ(goal_at(0.0, q2 + pi).sigma, goal_at(0.0, q2).sigma);
    EXPECT_NEAR(goal_at(0.0, q2 + pi).width, goal_at(0.0, q2).width, 1e-14);
  }
}

TEST(ModuloTurn, IsInTheHalfOpenTurnOnBothSidesOfEveryBoundary) {
  for (const double turns : {-1e6, -1000.0, -3.0, -1.0, 0.0, 1.0, 2.0, 1e3, 1e6}) {
    const double boundary = turns * 2.0 * pi;
    for (const double x : {std::nextafter(boundary, -infinity), boundary, std::nextafter(boundary, infinity)}) {
      EXPECT_GE(modulo_turn(x), 0.0) << x;
      EXPECT_LT(modulo_turn(x), 2.0 * pi) << x;
    }
  }
  EXPECT_EQ(modulo_turn(0.0), 0.0);
  EXPECT_EQ(modulo_turn(2.0 * pi), 0.0);
  EXPECT_EQ(modulo_turn(-2.0 * pi), 0.0);
  EXPECT_EQ(modulo_turn(-1e-300), 0.0);
  EXPECT_EQ(modulo_turn(1e-300), 1e-300);
  EXPECT_EQ(modulo_turn(std::nextafter(2.0 * pi, 0.0)), std::nextafter(2.0 * pi, 0.0));
}

/// How far apart two angles are on the circle, in extended precision.
long double circle_distance(long double a, long double b) {
  return std::abs(std::remainder(a - b, 2.0L * std::numbers::pi_v<long double>));
}

TEST(ModuloTurn, IsTheSameAngleToTheStatedError) {
  for (double x = 1e-3; x < 1e9; x *= 1.0173) {
    for (const double angle : {x, -x}) {
      const long double bound = 0x1p-51L * std::max(std::abs(static_cast<long double>(angle)), 2.0L * pi);
      EXPECT_LE(static_cast<double>(circle_distance(modulo_turn(angle), angle) / bound), 1.0) << angle;
    }
  }
}

TEST(ModuloTurn, OfANonFiniteAngleIsNotANumber) {
  for (const double x : {infinity, -infinity, std::nan("")}) {
    EXPECT_TRUE(std::isnan(modulo_turn(x)));
    EXPECT_TRUE(std::isnan(wrap(x)));
  }
}

TEST(Wrap, IsOpenAtMinusPiAndClosedAtPi) {
  EXPECT_EQ(wrap(pi), pi);
  EXPECT_EQ(wrap(-pi), pi);
  EXPECT_EQ(wrap(std::nextafter(pi, 0.0)), std::nextafter(pi, 0.0));
  EXPECT_LT(wrap(std::nextafter(pi, 4.0)), -pi + 1e-14);
  EXPECT_GT(wrap(std::nextafter(-pi, -4.0)), pi - 1e-14);
  EXPECT_LT(wrap(std::nextafter(-pi, 0.0) + 1e-15), -pi + 1e-14);
  EXPECT_NEAR(wrap(3.0 * pi - 0.25), pi - 0.25, 1e-14);
  EXPECT_NEAR(wrap(-1e5 * pi + 0.25), 0.25, 1e-10);
}

TEST(Wrap, KeepsSmallAnglesOfEitherSign) {
  for (const double x : {1e-3, 0.5, 3.0}) {
    EXPECT_EQ(wrap(x), x);
    EXPECT_NEAR(wrap(-x), -x, 1e-15);
  }
  EXPECT_EQ(wrap(0.0), 0.0);
}

TEST(ActiveError, IsTheNormOfPositionErrorAndVelocity) {
  const Goal goal = goal_at(1.0, 0.7);
  EXPECT_DOUBLE_EQ(active_error({4.0, 0.0, -4.0, 9.0}, goal), 5.0);
  EXPECT_EQ(active_error({1.0, 2.0, 0.0, 3.0}, goal), 0.0);
}

TEST(PassiveError, IsThePapersEpsilonOnTheCircle) {
  const Goal goal = goal_at(0.0, 0.7);
  EXPECT_DOUBLE_EQ(passive_error({0.0, 0.9, 0.0, -0.3}, goal), 0.2 + 0.3);
  EXPECT_NEAR(passive_error({0.0, 0.9 - 20.0 * pi, 0.0, 0.0}, goal), 0.2, 1e-13);
  EXPECT_NEAR(passive_error({0.0, 0.5 + 2.0 * pi, 0.0, 0.0}, goal), 0.2, 1e-14);
  EXPECT_NEAR(passive_error({0.0, 0.7 + pi, 0.0, 0.0}, goal), pi, 1e-14);
}

TEST(PassiveError, OfANonFiniteAngleIsNeverSmall) {
  EXPECT_FALSE(passive_error({0.0, std::nan(""), 0.0, 0.0}, goal_at(0.0, 0.7)) <= 0.005);
  EXPECT_FALSE(passive_error({0.0, infinity, 0.0, 0.0}, goal_at(0.0, 0.7)) <= 0.005);
}

}  // namespace
}  // namespace steerstat
