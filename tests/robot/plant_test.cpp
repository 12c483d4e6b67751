#include "robot/plant.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "dual.hpp"
#include "robot/linearised.hpp"

namespace steerstat {
namespace {

using testing::cosine;
using testing::Dual;
using testing::sine;

struct Case {
  PlantParameters<double> plant;
  State<double> x;
  double tau;
};

/// Random plants, states and forces, with friction or without.
std::vector<Case> cases(bool friction) {
  std::mt19937_64 generator(7);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator);
  };
  std::vector<Case> result;
  for (int i = 0; i < 200; ++i) {
    Case c;
    c.plant = {between(0.5, 2), between(0.5, 2), between(-1, 1), between(0.3, 2), 0.0, 0.0};
    if (friction) {
      c.plant.f1 = between(0, 0.5);
      c.plant.f2 = between(0, 0.5);
    }
    c.x = {between(-2, 2), between(-4, 4), between(-2, 2), between(-2, 2)};
    c.tau = between(-5, 5);
    result.push_back(c);
  }
  return result;
}

/// The accelerations at `x`, with sine and cosine of its own.
template <class Real>
Accelerations<Real> accelerations_at(const PlantParameters<Real>& plant, const State<Real>& x, const Real& tau) {
  return accelerations(constants_of(plant), x, sine(x.q2), cosine(x.q2), tau);
}

TEST(Plant, KineticEnergyIsThatOfTwoRigidBodies) {
  for (const auto& [plant, x, tau] : cases(false)) {
    // Link 2's centre of mass is at (q1 + d2 cos q2, d2 sin q2) (Fig. 1).
    const double vx = x.q1_dot - plant.d2 * std::sin(x.q2) * x.q2_dot;
    const double vy = plant.d2 * std::cos(x.q2) * x.q2_dot;
    const double expected = 0.5 * plant.m1 * x.q1_dot * x.q1_dot + 0.5 * plant.m2 * (vx * vx + vy * vy) +
                            0.5 * plant.I2 * x.q2_dot * x.q2_dot;
    EXPECT_NEAR(kinetic_energy(constants_of(plant), x, std::sin(x.q2)), expected, 1e-14);
  }
}

/// d/dt (dE/dq_i') - dE/dq_i - (generalised force of joint i), zero on a trajectory. E is the Lagrangian.
struct LagrangeResiduals {
  double joint1;
  double joint2;
};

LagrangeResiduals lagrange_residuals(const Case& c) {
  using Once = Dual<double>;
  using Twice = Dual<Once>;
  const Accelerations<double> a = accelerations_at(c.plant, c.x, c.tau);
  const PlantConstants<double> k = constants_of(c.plant);
  const PlantConstants<Twice> constants{Twice(k.mass), Twice(k.moment), Twice(k.inertia), Twice(k.f1), Twice(k.f2)};
  // The inner slope is d/dt, the outer one d/d(coordinate or velocity).
  const auto energy = [&](double dq2, double dq1_dot, double dq2_dot) {
    const Twice q2(Once(c.x.q2, c.x.q2_dot), Once(dq2));
    const Twice q1_dot(Once(c.x.q1_dot, a.q1_ddot), Once(dq1_dot));
    const Twice q2_dot(Once(c.x.q2_dot, a.q2_ddot), Once(dq2_dot));
    return kinetic_energy(constants, State<Twice>{Twice(0.0), q2, q1_dot, q2_dot}, sine(q2)).slope;
  };
  return {energy(0, 1, 0).slope - (c.tau - c.plant.f1 * c.x.q1_dot),
          energy(0, 0, 1).slope - energy(1, 0, 0).value - (-c.plant.f2 * c.x.q2_dot)};
}

TEST(Plant, AccelerationsSatisfyLagrangesEquationsWithAndWithoutFriction) {
  for (const bool friction : {false, true}) {
    for (const Case& c : cases(friction)) {
      const auto [joint1, joint2] = lagrange_residuals(c);
      EXPECT_NEAR(joint1, 0.0, 1e-12);
      EXPECT_NEAR(joint2, 0.0, 1e-12);
    }
  }
}

TEST(Plant, PowerOfTheForceLessFrictionsLossesIsTheRateOfEnergy) {
  for (const bool friction : {false, true}) {
    for (const auto& [plant, x, tau] : cases(friction)) {
      const Accelerations<double> a = accelerations_at(plant, x, tau);
      const PlantConstants<double> k = constants_of(plant);
      using Real = Dual<double>;
      const State<Real> moving{{x.q1, x.q1_dot}, {x.q2, x.q2_dot}, {x.q1_dot, a.q1_ddot}, {x.q2_dot, a.q2_ddot}};
      const PlantConstants<Real> constants{Real(k.mass), Real(k.moment), Real(k.inertia), Real(k.f1), Real(k.f2)};
      const double rate = kinetic_energy(constants, moving, sine(moving.q2)).slope;
      const double losses = plant.f1 * x.q1_dot * x.q1_dot + plant.f2 * x.q2_dot * x.q2_dot;
      EXPECT_NEAR(rate, tau * x.q1_dot - losses, 1e-12);
      EXPECT_EQ(losses > 0.0, friction);
    }
  }
}

TEST(Plant, FreeMotionKeepsItsEnergyAndMomentumAndFrictionTakesEnergy) {
  const auto energy_after = [](double f1, double f2, double& momentum) {
    const PlantParameters<double> plant{1.1, 0.9, 0.5, 1.0, f1, f2};
    const PlantConstants<double> k = constants_of(plant);
    State<double> x{0.0, 0.4, 0.3, 0.7};
    const auto rates = [&](const State<double>& y) {
      const auto [q1_ddot, q2_ddot] = accelerations_at(plant, y, 0.0);
      return State<double>{y.q1_dot, y.q2_dot, q1_ddot, q2_ddot};
    };
    const auto moved = [](const State<double>& y, const State<double>& r, double h) {
      return State<double>{y.q1 + h * r.q1, y.q2 + h * r.q2, y.q1_dot + h * r.q1_dot, y.q2_dot + h * r.q2_dot};
    };
    const double h = 1e-3;
    for (int i = 0; i < 5000; ++i) {  // Runge-Kutta 4 over 5 s
      const auto r1 = rates(x);
      const auto r2 = rates(moved(x, r1, h / 2));
      const auto r3 = rates(moved(x, r2, h / 2));
      const auto r4 = rates(moved(x, r3, h));
      x = moved(moved(moved(moved(x, r1, h / 6), r2, h / 3), r3, h / 3), r4, h / 6);
    }
    momentum = k.mass * x.q1_dot - k.moment * std::sin(x.q2) * x.q2_dot;
    return kinetic_energy(k, x, std::sin(x.q2));
  };
  const double start = 0.5 * 2.0 * 0.09 - 0.45 * std::sin(0.4) * 0.21 + 0.5 * 1.225 * 0.49;
  double momentum = 0.0;
  EXPECT_NEAR(energy_after(0.0, 0.0, momentum), start, 1e-11);
  EXPECT_NEAR(momentum, 2.0 * 0.3 - 0.45 * std::sin(0.4) * 0.7, 1e-11);
  EXPECT_LT(energy_after(0.05, 0.0, momentum), start - 1e-3);
  EXPECT_LT(energy_after(0.0, 0.05, momentum), start - 1e-3);
}

TEST(Plant, LinearisingForceGivesTheAccelerationAskedForAndEquation4) {
  for (const auto& [plant, x, a] : cases(false)) {
    const PlantConstants<double> k = constants_of(plant);
    const double s = std::sin(x.q2);
    const double c = std::cos(x.q2);
    const auto [q1_ddot, q2_ddot] = accelerations(k, x, s, c, linearising_force(k, a, s, c, x.q2_dot));
    EXPECT_NEAR(q1_ddot, a, 1e-12);                        // (3)
    EXPECT_NEAR(q2_ddot, coupling(plant) * s * a, 1e-12);  // (4)
  }
}

TEST(Plant, LinearisingForceOfAnotherPlantDoesNotGiveTheAcceleration) {
  const PlantParameters<double> nominal{};
  PlantParameters<double> heavier{};
  heavier.m2 = 1.2;
  const State<double> x{0.0, 0.7, 0.1, 0.2};
  const double s = std::sin(x.q2);
  const double c = std::cos(x.q2);
  const double tau = linearising_force(constants_of(nominal), 1.0, s, c, x.q2_dot);
  EXPECT_LT(accelerations(constants_of(heavier), x, s, c, tau).q1_ddot, 0.95);
}

TEST(Plant, NominalCouplingIsTwoFifths) {
  EXPECT_DOUBLE_EQ(coupling(PlantParameters<double>{}), 0.4);
}

TEST(Plant, MirroringTheAngleMirrorsThePassiveJointAlone) {
  for (const auto& [plant, x, tau] : cases(true)) {
    const State<double> mirrored{x.q1, -x.q2, x.q1_dot, -x.q2_dot};
    const Accelerations<double> here = accelerations_at(plant, x, tau);
    const Accelerations<double> there = accelerations_at(plant, mirrored, tau);
    EXPECT_DOUBLE_EQ(there.q1_ddot, here.q1_ddot);
    EXPECT_DOUBLE_EQ(there.q2_ddot, -here.q2_ddot);
    const PlantConstants<double> k = constants_of(plant);
    EXPECT_DOUBLE_EQ(linearising_force(k, tau, std::sin(-x.q2), std::cos(-x.q2), -x.q2_dot),
                     linearising_force(k, tau, std::sin(x.q2), std::cos(x.q2), x.q2_dot));
  }
}

TEST(Plant, HalfATurnMirrorsTheActiveJointAlone) {
  for (const auto& [plant, x, tau] : cases(true)) {
    const State<double> turned{-x.q1, x.q2 + std::numbers::pi, -x.q1_dot, x.q2_dot};
    const Accelerations<double> here = accelerations_at(plant, x, tau);
    const Accelerations<double> there = accelerations_at(plant, turned, -tau);
    EXPECT_NEAR(there.q1_ddot, -here.q1_ddot, 1e-12);
    EXPECT_NEAR(there.q2_ddot, here.q2_ddot, 1e-12);
    // The same acceleration with the other sign is the same force with the other sign.
    const PlantConstants<double> k = constants_of(plant);
    EXPECT_NEAR(linearising_force(k, -tau, std::sin(turned.q2), std::cos(turned.q2), x.q2_dot),
                -linearising_force(k, tau, std::sin(x.q2), std::cos(x.q2), x.q2_dot), 1e-12);
  }
}

}  // namespace
}  // namespace steerstat
