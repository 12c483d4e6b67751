#include "study/plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "planned_study.hpp"
#include "sampling/stream.hpp"
#include "study/inputs.hpp"

namespace steerstat {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(Plan, TheEmptySpecIsOneTrialOfTheNominalRobotFromThePapersStart) {
  const Plan plan = plan_of("{}");
  EXPECT_EQ(plan.trials(), 1U);
  EXPECT_EQ(plan.cells(), 1U);
  EXPECT_THAT(plan.varying(), IsEmpty());
  const TrialParameters parameters = plan.parameters(0);
  EXPECT_EQ(parameters.plant, PlantParameters<double>{});
  EXPECT_EQ(parameters.nominal, PlantParameters<double>{});
  EXPECT_EQ(parameters.start, (State<double>{1.0, -0.7853981633974483, 0.0, 0.0}));
  EXPECT_EQ(parameters.goal, goal_at(0.0, 0.7853981633974483));
  EXPECT_EQ(parameters.controller, Controller{});
}

TEST(Plan, FixedNumbersReachTheTrial) {
  const TrialParameters parameters = plan_of(R"({"nominal": {"m1": 2, "d2": 0.25}, "plant": {"m2": 3},
      "goal": {"q1": 1, "q2": 2}, "horizon": 50, "initial_state": {"q2_dot": 0.5},
      "controller": {"realignment": "never", "alignment": {"kp": 9}, "swing": {"min_authority": 0.1}}})")
                                         .parameters(0);
  EXPECT_EQ(parameters.nominal.m1, 2.0);
  EXPECT_EQ(parameters.plant.m1, 2.0);  // as the nominal one
  EXPECT_EQ(parameters.nominal.m2, 1.0);
  EXPECT_EQ(parameters.plant.m2, 3.0);
  EXPECT_EQ(parameters.goal, goal_at(1.0, 2.0));
  EXPECT_EQ(parameters.start.q2_dot, 0.5);
  EXPECT_EQ(parameters.controller.horizon, 50.0);
  EXPECT_EQ(parameters.controller.realignment, Realignment::never);
  EXPECT_EQ(parameters.controller.alignment.kp, 9.0);
  EXPECT_EQ(parameters.controller.swing.min_authority, 0.1);
  EXPECT_EQ(parameters.controller.coupling, 0.25 / 1.0625);  // of the nominal plant, whatever the true one is
}

TEST(Plan, DrawsAreTheDistributionsQuantilesOfTheVariablesOwnStream) {
  const Plan plan = plan_of(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"triangular": [0, 0.01, 0.05]}},
      "sampling": {"trials": 10, "seed": 42}})");
  EXPECT_THAT(plan.varying(), ElementsAre("plant.m1", "plant.f2"));
  for (std::uint64_t i = 0; i < 10; ++i) {
    const double m1 = Uniform{0.8, 1.2}.quantile(UniformStream(42, "plant.m1").at(i));
    const double f2 = Triangular{0.0, 0.01, 0.05}.quantile(UniformStream(42, "plant.f2").at(i));
    EXPECT_THAT(values_of(plan, i), ElementsAre(m1, f2));
    EXPECT_EQ(plan.parameters(i).plant.m1, m1);
    EXPECT_EQ(plan.parameters(i).plant.f2, f2);
    EXPECT_EQ(plan.parameters(i).nominal.m1, 1.0);
  }
}

TEST(Plan, RelativeDrawsMultiplyTheNominalValue) {
  const Plan plan = plan_of(R"({"nominal": {"m1": 4, "d2": -0.5},
      "plant": {"m1": {"uniform": [0.5, 1.5], "relative": true}, "d2": {"uniform": [0.9, 1.1], "relative": true}},
      "sampling": {"trials": 20}})");
  const Uniform mass_factor{0.5, 1.5};
  const Uniform length_factor{0.9, 1.1};
  for (std::uint64_t i = 0; i < 20; ++i) {
    EXPECT_EQ(plan.parameters(i).plant.m1, 4.0 * mass_factor.quantile(UniformStream(1, "plant.m1").at(i)));
    EXPECT_EQ(values_of(plan, i)[1], -0.5 * length_factor.quantile(UniformStream(1, "plant.d2").at(i)));
  }
}

TEST(Plan, MoreTrialsBeginWithTheTrialsOfFewer) {
  const std::string spec = R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "m2": {"sweep": [0.9, 1, 1.1]}},
      "initial_state": {"q1": {"normal": {"mean": 0, "std": 1}}}, "sampling": {"trials": )";
  const Plan few = plan_of(spec + "10}}");
  const Plan many = plan_of(spec + "1000}}");
  EXPECT_EQ(few.trials(), 30U);
  EXPECT_EQ(many.trials(), 3000U);
  for (std::uint64_t i = 0; i < few.trials(); ++i) {
    EXPECT_EQ(values_of(few, i), values_of(many, i)) << i;
    EXPECT_EQ(few.cell_of(i), many.cell_of(i)) << i;
  }
}

TEST(Plan, AnotherVaryingInputChangesNoDrawOfTheFirst) {
  const Plan one = plan_of(R"({"plant": {"m2": {"uniform": [0.8, 1.2]}}, "sampling": {"trials": 50}})");
  const Plan two = plan_of(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "m2": {"uniform": [0.8, 1.2]}},
      "controller": {"contraction": {"eta1": {"sweep": [0.3, 0.5]}}}, "sampling": {"trials": 50}})");
  for (std::uint64_t draw = 0; draw < 50; ++draw) {
    EXPECT_EQ(one.parameters(draw).plant.m2, two.parameters(2 * draw).plant.m2);
    EXPECT_EQ(one.parameters(draw).plant.m2, two.parameters(2 * draw + 1).plant.m2);
  }
}

TEST(Plan, AllCellsShareTheDraws) {
  const Plan plan = plan_of(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "controller": {"contraction":
      {"eta1": {"sweep": [0.3, 0.5, 0.7]}, "eta2": {"sweep": [0.4, 0.6]}}}, "sampling": {"trials": 5}})");
  ASSERT_EQ(plan.cells(), 6U);
  ASSERT_EQ(plan.trials(), 30U);
  std::set<double> draws;
  for (std::uint64_t i = 0; i < plan.trials(); ++i) {
    draws.insert(plan.parameters(i).plant.m1);
    EXPECT_EQ(plan.parameters(i).plant.m1, plan.parameters(i - i % 6).plant.m1);
  }
  EXPECT_EQ(draws.size(), 5U);
}

TEST(Plan, SweepsMakeTheFullFactorialWithTheLastOneFastest) {
  const Plan plan = plan_of(R"({"controller": {"contraction": {"eta1": {"sweep": [0.3, 0.5]},
      "eta2": {"sweep": [0.4, 0.6, 0.8]}}}, "sampling": {"method": "grid"}})");
  ASSERT_EQ(plan.trials(), 6U);
  std::vector<std::pair<double, double>> pairs;
  for (std::uint64_t i = 0; i < 6; ++i) {
    const auto& contraction = plan.parameters(i).controller.contraction;
    pairs.emplace_back(contraction.eta1, contraction.eta2);
    const auto swept = plan.sweep_values(plan.cell_of(i));
    ASSERT_EQ(swept.size(), 2U);
    EXPECT_EQ(swept[0].name, "controller.contraction.eta1");
    EXPECT_EQ(swept[0].value, contraction.eta1);
    EXPECT_EQ(swept[1].value, contraction.eta2);
  }
  EXPECT_THAT(pairs, ElementsAre(std::pair(0.3, 0.4), std::pair(0.3, 0.6), std::pair(0.3, 0.8), std::pair(0.5, 0.4),
                                 std::pair(0.5, 0.6), std::pair(0.5, 0.8)));
}

TEST(Plan, ExplicitTrialsSetTheirInputsAndLeaveTheOthers) {
  const Plan plan = plan_of(R"({"plant": {"m1": 5, "m2": 2}, "sampling": {"method": "explicit", "trials":
      [{"plant.m1": 1.1, "controller.rest_speed": 0.01}, {"plant.m1": 1.2, "controller.rest_speed": 0.02}]}})");
  EXPECT_EQ(plan.trials(), 2U);
  EXPECT_THAT(plan.varying(), ElementsAre("plant.m1", "controller.rest_speed"));
  EXPECT_EQ(plan.parameters(0).plant.m1, 1.1);
  EXPECT_EQ(plan.parameters(1).plant.m1, 1.2);
  EXPECT_EQ(plan.parameters(1).controller.rest_speed, 0.02);
  EXPECT_EQ(plan.parameters(1).plant.m2, 2.0);
}

TEST(Plan, ExplicitTrialsRunInEveryCell) {
  const Plan plan = plan_of(R"({"plant": {"f1": {"sweep": [0, 0.01]}}, "sampling": {"method": "explicit", "trials":
      [{"plant.m1": 1.1}, {"plant.m1": 1.2}, {"plant.m1": 1.3}]}})");
  ASSERT_EQ(plan.trials(), 6U);
  EXPECT_EQ(plan.parameters(4).plant.m1, 1.3);
  EXPECT_EQ(plan.parameters(4).plant.f1, 0.0);
  EXPECT_EQ(plan.parameters(5).plant.m1, 1.3);
  EXPECT_EQ(plan.parameters(5).plant.f1, 0.01);
}

TEST(Plan, ParametersAreThoseOfTheDrawnValues) {
  const Plan plan = plan_of(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "initial_state": {"q2": {"sweep": [0, 1]}},
      "sampling": {"trials": 3}})");
  for (std::uint64_t i = 0; i < plan.trials(); ++i) {
    const TrialParameters whole = plan.parameters(i);
    const TrialParameters parts = plan.parameters_with(i, values_of(plan, i));
    EXPECT_EQ(whole.plant, parts.plant);
    EXPECT_EQ(whole.start, parts.start);
    EXPECT_EQ(whole.controller, parts.controller);
  }
}

TEST(Plan, EveryInputReachesItsOwnField) {
  for (const InputDefinition& definition : input_definitions()) {
    const double value = definition.default_value() * 0.75 + 0.125;
    Study study = planned_study("{}");
    for (Input& input : study.inputs) {
      if (input.name == definition.name) input.value = Sweep{{value}};
    }
    TrialParameters expected = plan_of("{}").parameters(0);
    definition.field(expected) = value;
    const TrialParameters got = Plan(study).parameters(0);
    EXPECT_EQ(got.plant, expected.plant) << definition.name;
    EXPECT_EQ(got.start, expected.start) << definition.name;
    EXPECT_EQ(got.controller, expected.controller) << definition.name;
    EXPECT_EQ(got.disturbance, expected.disturbance) << definition.name;
    EXPECT_EQ(got.actuator, expected.actuator) << definition.name;
    EXPECT_EQ(got.sensor.bias, expected.sensor.bias) << definition.name;
    EXPECT_EQ(got.sensor.noise, expected.sensor.noise) << definition.name;
  }
}

TEST(Plan, RefusesAStudyThatNoSpecGives) {
  Study unknown = planned_study("{}");
  unknown.inputs.push_back({"plant.m3", 1.0});
  EXPECT_THROW(Plan{unknown}, std::invalid_argument);

  Study ragged = planned_study(R"({"sampling": {"method": "explicit", "trials": [{"plant.m1": 1}]}})");
  ragged.sampling.explicit_values.push_back(2.0);
  EXPECT_THROW(Plan{ragged}, std::invalid_argument);

  Study swept = planned_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "sampling": {"method": "sobol_indices"}})");
  swept.inputs.back().value = Sweep{{1.0, 2.0}};
  EXPECT_THROW(Plan{swept}, std::invalid_argument);

  Study nothing = planned_study("{}");
  nothing.sampling.method = SamplingMethod::sobol_indices;
  EXPECT_THROW(Plan{nothing}, std::invalid_argument);

  Study twice = planned_study(R"({"sampling": {"method": "explicit", "trials": [{"plant.m1": 1}]}})");
  twice.inputs.front().value = Sweep{{1.0, 2.0}};
  EXPECT_THROW(Plan{twice}, std::invalid_argument);

  Study fixed = planned_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}})");
  fixed.sampling.correlations.push_back({"plant.m1", "plant.m2", 0.5});
  EXPECT_THROW(Plan{fixed}, std::invalid_argument);

  Study contradictory = planned_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "m2": {"uniform": [0.8, 1.2]}}})");
  contradictory.sampling.correlations.push_back({"plant.m1", "plant.m2", 1.0});
  EXPECT_THROW(Plan{contradictory}, std::invalid_argument);
}

}  // namespace
}  // namespace steerstat
