#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "dual.hpp"
#include "robot/actuator.hpp"
#include "robot/disturbance.hpp"

namespace steerstat {
namespace {

using testing::Dual;
using testing::sine;

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Case {
  PlantParameters<double> plant;
  Disturbance<double> disturbance;
  State<double> x;
  double tau;
};

std::vector<Case> cases() {
  std::mt19937_64 generator(11);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator);
  };
  std::vector<Case> result(200);
  for (Case& c : result) {
    c.plant = {between(0.5, 2), between(0.5, 2), between(-1, 1), between(0.3, 2), between(0, 0.5), between(0, 0.5)};
    c.disturbance = {between(0, 1), between(0, 1), between(1e-3, 1), between(1e-3, 1), between(-2, 2), between(-2, 2)};
    c.x = {between(-2, 2), between(-4, 4), between(-2, 2), between(-2, 2)};
    c.tau = between(-5, 5);
  }
  return result;
}

double potential_at(const Case& c, double q1, double q2) {
  return potential_energy(constants_of(c.plant), c.disturbance, {q1, q2, 0.0, 0.0}, std::sin(q2), std::cos(q2));
}

TEST(Disturbance, PotentialEnergyIsThatOfBothCentresOfMass) {
  for (const Case& c : cases()) {
    const double x = c.x.q1 + c.plant.d2 * std::cos(c.x.q2);  // of link 2 (Fig. 1)
    const double y = c.plant.d2 * std::sin(c.x.q2);
    const auto& d = c.disturbance;
    const double expected = -c.plant.m1 * d.gravity_x * c.x.q1 - c.plant.m2 * (d.gravity_x * x + d.gravity_y * y);
    EXPECT_NEAR(potential_at(c, c.x.q1, c.x.q2), expected, 1e-13);
  }
}

TEST(Disturbance, TiltsForcesAreTheSlopesOfThePotential) {
  for (Case c : cases()) {
    c.disturbance.coulomb1 = c.disturbance.coulomb2 = 0.0;
    const auto [force, torque] =
        disturbing_forces(constants_of(c.plant), c.disturbance, c.x, std::sin(c.x.q2), std::cos(c.x.q2));
    constexpr double h = 1e-5;
    EXPECT_NEAR(force, -(potential_at(c, c.x.q1 + h, c.x.q2) - potential_at(c, c.x.q1 - h, c.x.q2)) / (2 * h), 1e-8);
    EXPECT_NEAR(torque, -(potential_at(c, c.x.q1, c.x.q2 + h) - potential_at(c, c.x.q1, c.x.q2 - h)) / (2 * h), 1e-8);
  }
}

TEST(Disturbance, PowerInLessLossesIsTheRateOfKineticAndPotentialEnergy) {
  for (const Case& c : cases()) {
    const PlantConstants<double> k = constants_of(c.plant);
    const double s = std::sin(c.x.q2);
    const double cosine = std::cos(c.x.q2);
    const auto a = accelerations(k, c.x, s, cosine, c.tau, disturbing_forces(k, c.disturbance, c.x, s, cosine));
    using Real = Dual<double>;
    const State<Real> moving{
        {c.x.q1, c.x.q1_dot}, {c.x.q2, c.x.q2_dot}, {c.x.q1_dot, a.q1_ddot}, {c.x.q2_dot, a.q2_ddot}};
    const PlantConstants<Real> constants{Real(k.mass), Real(k.moment), Real(k.inertia), Real(k.f1), Real(k.f2)};
    constexpr double h = 1e-5;
    const double potential_rate = (potential_at(c, c.x.q1 + h * c.x.q1_dot, c.x.q2 + h * c.x.q2_dot) -
                                   potential_at(c, c.x.q1 - h * c.x.q1_dot, c.x.q2 - h * c.x.q2_dot)) /
                                  (2 * h);
    const double rate = kinetic_energy(constants, moving, sine(moving.q2)).slope + potential_rate;
    const auto& d = c.disturbance;
    const double rubbing = d.coulomb1 * c.x.q1_dot * coulomb_share(c.x.q1_dot, d.coulomb_speed1) +
                           d.coulomb2 * c.x.q2_dot * coulomb_share(c.x.q2_dot, d.coulomb_speed2);
    EXPECT_GT(rubbing, 0.0);
    const double losses = c.plant.f1 * c.x.q1_dot * c.x.q1_dot + c.plant.f2 * c.x.q2_dot * c.x.q2_dot + rubbing;
    EXPECT_NEAR(rate, c.tau * c.x.q1_dot - losses, 1e-8);
  }
}

TEST(Disturbance, CoulombFrictionsShareIsOddAndGrowsFromNothingToAll) {
  EXPECT_EQ(coulomb_share(0.0, 1e-3), 0.0);
  EXPECT_NEAR(coulomb_share(1e-3, 1e-3), std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(coulomb_share(1e-2, 1e-3), 0.99504, 1e-5);
  for (const double v : {1e-9, 1e-4, 3e-3, 0.2, 40.0}) {
    EXPECT_EQ(coulomb_share(-v, 1e-3), -coulomb_share(v, 1e-3));
    EXPECT_LT(coulomb_share(v, 1e-3), 1.0 + 1e-15);
    EXPECT_LT(coulomb_share(0.99 * v, 1e-3), coulomb_share(v, 1e-3));
  }
}

TEST(Disturbance, IsPresentOnceAForceIs) {
  EXPECT_FALSE(is_present(Disturbance<double>{}));
  Disturbance<double> speeds;
  speeds.coulomb_speed1 = speeds.coulomb_speed2 = 1.0;
  EXPECT_FALSE(is_present(speeds)) << "smoothing velocities alone do nothing";
  for (const auto field : {&Disturbance<double>::coulomb1, &Disturbance<double>::coulomb2,
                           &Disturbance<double>::gravity_x, &Disturbance<double>::gravity_y}) {
    Disturbance<double> disturbance;
    disturbance.*field = std::numeric_limits<double>::denorm_min();
    EXPECT_TRUE(is_present(disturbance));
  }
}

TEST(Actuator, ScalesAndThenClampsOnBothSidesOfTheLimit) {
  const Actuator<double> actuator{0.5, 2.0};
  EXPECT_EQ(applied_force(actuator, 3.0), 1.5);
  EXPECT_EQ(applied_force(actuator, 4.0), 2.0);
  EXPECT_EQ(applied_force(actuator, std::nextafter(4.0, 0.0)), std::nextafter(2.0, 0.0));
  EXPECT_EQ(applied_force(actuator, std::nextafter(4.0, 5.0)), 2.0);
  EXPECT_EQ(applied_force(actuator, 1e300), 2.0);
  EXPECT_EQ(applied_force(actuator, -1e300), -2.0);
  EXPECT_EQ(applied_force(actuator, std::nextafter(-4.0, 0.0)), std::nextafter(-2.0, 0.0));
}

TEST(Actuator, TheIdealOneChangesNoBit) {
  for (const double tau : {0.0, -0.0, 0.1, -1e300, 5e-324, infinity, -infinity}) {
    EXPECT_EQ(applied_force(Actuator<double>{}, tau), tau);
    EXPECT_EQ(std::signbit(applied_force(Actuator<double>{}, tau)), std::signbit(tau));
  }
  EXPECT_TRUE(std::isnan(applied_force(Actuator<double>{}, std::numeric_limits<double>::quiet_NaN())));
}

}  // namespace
}  // namespace steerstat
