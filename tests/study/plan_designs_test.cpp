// What the designs of the sampling make of a plan's draws.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "planned_study.hpp"
#include "sampling/sobol.hpp"
#include "sampling/stream.hpp"

namespace steerstat {
namespace {

using ::testing::ElementsAre;

TEST(Plan, ASobolDesignWithMoreTrialsBeginsWithTheTrialsOfFewer) {
  const std::string spec = R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "m2": {"sweep": [0.9, 1]}, "f1": {"uniform":
      [0, 0.05]}}, "sampling": {"method": "sobol", "correlation": [["plant.m1", "plant.f1", 0.5]], "trials": )";
  const Plan few = plan_of(spec + "128}}");
  const Plan many = plan_of(spec + "256}}");
  for (std::uint64_t i = 0; i < few.trials(); ++i) EXPECT_EQ(values_of(few, i), values_of(many, i)) << i;
}

TEST(Plan, SobolDrawsAreTheDesignsInTheOrderOfTheInputs) {
  const Plan plan = plan_of(R"({"initial_state": {"q1": {"uniform": [0, 1]}}, "plant": {"m1": {"uniform": [1, 2]}},
      "sampling": {"method": "sobol", "trials": 100, "seed": 9}})");
  const Sobol design(9, std::vector<std::string>{"plant.m1", "initial_state.q1"});
  for (std::uint64_t i = 0; i < 100; ++i) {
    EXPECT_THAT(values_of(plan, i), ElementsAre(Uniform{1.0, 2.0}.quantile(design.coordinate(i, 0)),
                                                Uniform{0.0, 1.0}.quantile(design.coordinate(i, 1))));
  }
}

TEST(Plan, ALatinHypercubesStrataAreThoseOfItsTrialsInEveryCell) {
  const Plan plan = plan_of(R"({"plant": {"m1": {"uniform": [1, 2]}, "m2": {"sweep": [1, 2, 3]}},
      "sampling": {"method": "latin_hypercube", "trials": 50}})");
  ASSERT_EQ(plan.trials(), 150U);
  std::map<std::uint64_t, std::set<double>> strata;
  for (std::uint64_t i = 0; i < plan.trials(); ++i) {
    strata[plan.cell_of(i)].insert(std::floor(50.0 * (values_of(plan, i)[0] - 1.0)));
  }
  ASSERT_EQ(strata.size(), 3U);
  for (const auto& cell : strata) EXPECT_EQ(cell.second.size(), 50U);
}

TEST(Plan, CorrelationsChangeTheirOwnInputsAloneAndNotTheFirstOfThem) {
  const std::string inputs = R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "m2": {"uniform": [0.8, 1.2]},
      "f2": {"uniform": [0, 0.05]}}, "initial_state": {"q1": {"normal": {"mean": 0, "std": 1}}},
      "sampling": {"trials": 50)";
  for (const std::string method : {"monte_carlo", "latin_hypercube", "sobol"}) {
    const std::string spec = inputs + R"(, "method": ")" + method + '"';
    const Plan independent = plan_of(spec + "}}");
    const Plan correlated = plan_of(spec + R"(, "correlation": [["plant.f2", "plant.m2", 0.7]]}})");
    for (std::uint64_t i = 0; i < 50; ++i) {
      const auto before = values_of(independent, i);
      const auto after = values_of(correlated, i);
      EXPECT_THAT(after, ElementsAre(before[0], before[1], ::testing::Ne(before[2]), before[3])) << method;
    }
  }
}

TEST(Plan, SobolIndicesPutTheVariantsOfARowBesideOneAnother) {
  const std::string spec = R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}},
      "sampling": {"method": "sobol_indices", "seed": 42, "trials": )";
  const Plan plan = plan_of(spec + "10}}");
  ASSERT_EQ(plan.variants(), 4U);
  ASSERT_EQ(plan.trials(), 40U);
  const Plan more = plan_of(spec + "1000}}");
  for (std::uint64_t row = 0; row < 10; ++row) {
    const double m1 = Uniform{0.8, 1.2}.quantile(UniformStream(42, "plant.m1").at(row));
    const double f2 = Uniform{0.0, 0.05}.quantile(UniformStream(42, "plant.f2").at(row));
    const double other_m1 = Uniform{0.8, 1.2}.quantile(UniformStream(42, "plant.m1'").at(row));
    const double other_f2 = Uniform{0.0, 0.05}.quantile(UniformStream(42, "plant.f2'").at(row));
    EXPECT_THAT(values_of(plan, 4 * row), ElementsAre(m1, f2));
    EXPECT_THAT(values_of(plan, 4 * row + 1), ElementsAre(other_m1, other_f2));
    EXPECT_THAT(values_of(plan, 4 * row + 2), ElementsAre(other_m1, f2));
    EXPECT_THAT(values_of(plan, 4 * row + 3), ElementsAre(m1, other_f2));
    for (std::uint64_t variant = 0; variant < 4; ++variant) {
      EXPECT_EQ(plan.is_independent(4 * row + variant), variant < 2);
      EXPECT_EQ(values_of(plan, 4 * row + variant), values_of(more, 4 * row + variant));
    }
  }
}

TEST(Plan, EveryTrialOfAnotherMethodIsIndependent) {
  const Plan plan = plan_of(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "m2": {"sweep": [1, 2, 3]}},
      "sampling": {"trials": 4}})");
  EXPECT_EQ(plan.variants(), 1U);
  for (std::uint64_t index = 0; index < plan.trials(); ++index) EXPECT_TRUE(plan.is_independent(index));
}

TEST(Plan, NoiseIsTheDrawsOwnAndCellsShareIt) {
  const std::string noisy = R"({"sensor": {"noise": {"q2": 0.001}}, "plant": {"f1": {"sweep": [0, 0.1]}},
      "sampling": {"trials": 50, "seed": )";
  const Plan plan = plan_of(noisy + "3}}");
  std::set<std::uint64_t> seeds;
  for (std::uint64_t draw = 0; draw < 50; ++draw) {
    const TrialParameters trial = plan.parameters(2 * draw);
    EXPECT_EQ(trial.sensor, plan.parameters(2 * draw + 1).sensor);
    EXPECT_EQ(trial.sensor, plan.parameters_with(2 * draw, values_of(plan, 2 * draw)).sensor);
    seeds.insert(trial.sensor.noise_seed);
  }
  EXPECT_EQ(seeds.size(), 50U);
  EXPECT_NE(plan_of(noisy + "4}}").parameters(0).sensor.noise_seed, plan.parameters(0).sensor.noise_seed);
  EXPECT_EQ(plan_of("{}").parameters(0).sensor, Sensor{}) << "without noise there is nothing to seed";
}

// Whatever else varies, the noise is one more input that is not varied: B has its own, and all others A's.
TEST(Plan, NoiseIsFrozenWhereSobolIndicesFreezeIt) {
  const Plan plan = plan_of(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}},
      "sensor": {"noise": {"q2": 0.001}}, "sampling": {"method": "sobol_indices", "trials": 5}})");
  ASSERT_EQ(plan.variants(), 4U);
  std::set<std::uint64_t> seeds;
  for (std::uint64_t row = 0; row < 5; ++row) {
    const auto seed = [&](std::uint64_t variant) { return plan.parameters(4 * row + variant).sensor.noise_seed; };
    EXPECT_NE(seed(1), seed(0));
    EXPECT_EQ(seed(2), seed(0));
    EXPECT_EQ(seed(3), seed(0));
    seeds.insert({seed(0), seed(1)});
  }
  EXPECT_EQ(seeds.size(), 10U);
}

}  // namespace
}  // namespace steerstat
