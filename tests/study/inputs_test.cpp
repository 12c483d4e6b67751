#include "study/inputs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "json_text.hpp"

namespace steerstat {
namespace {

const Range& range_of(std::string_view name) {
  return find_input(name)->range;
}

TEST(Inputs, DefaultsAreThoseOfTheControllersDefinition) {
  const auto value = [](std::string_view name) { return find_input(name)->default_value(); };
  EXPECT_EQ(value("plant.m1"), 1.0);
  EXPECT_EQ(value("plant.m2"), 1.0);
  EXPECT_EQ(value("plant.d2"), 0.5);
  EXPECT_EQ(value("plant.I2"), 1.0);
  EXPECT_EQ(value("plant.f1"), 0.0);
  EXPECT_EQ(value("plant.f2"), 0.0);
  EXPECT_EQ(value("initial_state.q1"), 1.0);
  EXPECT_EQ(value("initial_state.q2"), -0.7853981633974483);
  EXPECT_EQ(value("initial_state.q1_dot"), 0.0);
  EXPECT_EQ(value("initial_state.q2_dot"), 0.0);
  EXPECT_EQ(value("controller.alignment.kp"), 7.0);
  EXPECT_EQ(value("controller.alignment.kd"), 5.0);
  EXPECT_EQ(value("controller.alignment.tolerance"), 1e-3);
  EXPECT_EQ(value("controller.entry_fraction"), 0.5);
  EXPECT_EQ(value("controller.drift.min_speed"), 0.0);
  EXPECT_EQ(value("controller.rest_speed"), 1e-3);
  EXPECT_EQ(value("controller.swing.period"), 2.0);
  EXPECT_EQ(value("controller.swing.speed"), 0.2);
  EXPECT_EQ(value("controller.swing.max_amplitude"), 200.0);
  EXPECT_EQ(value("controller.swing.min_authority"), 0.4);
  EXPECT_EQ(value("controller.contraction.eta1"), 0.5);
  EXPECT_EQ(value("controller.contraction.eta2"), 0.6);
  EXPECT_EQ(value("controller.contraction.max_period"), 30.0);
  EXPECT_EQ(value("controller.convergence.tolerance"), 0.005);
  EXPECT_EQ(value("controller.convergence.active_tolerance"), 0.02);
  EXPECT_EQ(value("controller.alignment.max_duration"), 3.5);
  EXPECT_EQ(value("controller.robust.rate"), 0.4);
  EXPECT_EQ(value("controller.robust.period"), 1.8);
  EXPECT_EQ(value("controller.robust.alignment_time"), 1.2);
  EXPECT_EQ(value("controller.robust.travel_speed"), 0.25);
  EXPECT_EQ(value("controller.robust.entry_fraction"), 0.3);
  EXPECT_EQ(value("controller.robust.turning_angle"), 0.6);
  EXPECT_EQ(value("controller.robust.max_acceleration"), 19.0);
  EXPECT_EQ(value("controller.max_stroke"), INFINITY);
}

TEST(Inputs, ImperfectionsAreOffByDefault) {
  const std::set<std::string_view> on{"plant.coulomb_speed1", "plant.coulomb_speed2", "actuator.gain",
                                      "actuator.max_force"};
  std::size_t imperfections = 0;
  for (const InputDefinition& definition : input_definitions()) {
    if (!definition.is_imperfection) continue;
    ++imperfections;
    EXPECT_EQ(definition.default_value() != 0.0, on.contains(definition.name)) << definition.name;
  }
  EXPECT_EQ(imperfections, 16U);
  EXPECT_EQ(find_input("plant.coulomb_speed1")->default_value(), 1e-3);
  EXPECT_EQ(find_input("plant.coulomb_speed2")->default_value(), 1e-3);
  EXPECT_EQ(find_input("actuator.gain")->default_value(), 1.0);
  EXPECT_EQ(find_input("actuator.max_force")->default_value(), INFINITY);
}

TEST(Inputs, EveryInputHasItsOwnNameAndPlace) {
  std::set<std::string_view> names;
  std::set<double*> places;
  TrialParameters parameters;
  for (const InputDefinition& definition : input_definitions()) {
    names.insert(definition.name);
    places.insert(&definition.field(parameters));
    EXPECT_FALSE(definition.unit.empty()) << definition.name;
    // No limit is no number.
    const bool limits = definition.name != "actuator.max_force" && definition.name != "controller.max_stroke";
    EXPECT_EQ(definition.range.contains(definition.default_value()), limits) << definition.name;
  }
  EXPECT_EQ(names.size(), input_count);
  EXPECT_EQ(places.size(), input_count);
  EXPECT_EQ(find_input("plant.m3"), nullptr);
  EXPECT_EQ(input_names().front(), "plant.m1");
}

TEST(Inputs, OmittedPlantValuesEqualTheNominalOnes) {
  PlantParameters<double> nominal;
  nominal.m1 = 3.0;
  nominal.f2 = 0.25;
  const auto inputs = default_inputs(nominal);
  ASSERT_EQ(inputs.size(), input_count);
  EXPECT_EQ(std::get<double>(inputs[0].value), 3.0);
  EXPECT_EQ(inputs[5].name, "plant.f2");
  EXPECT_EQ(std::get<double>(inputs[5].value), 0.25);
}

TEST(Range, OpenBoundsExcludeAndClosedBoundsIncludeTheirNumber) {
  EXPECT_FALSE(range_of("plant.m1").contains(0.0));
  EXPECT_TRUE(range_of("plant.m1").contains(5e-324));
  EXPECT_TRUE(range_of("plant.f1").contains(0.0));
  EXPECT_FALSE(range_of("plant.f1").contains(-5e-324));
  EXPECT_FALSE(range_of("plant.d2").contains(0.0));
  EXPECT_TRUE(range_of("plant.d2").contains(-5e-324));
  EXPECT_FALSE(range_of("controller.contraction.eta1").contains(1.0));
  EXPECT_TRUE(range_of("controller.contraction.eta1").contains(std::nextafter(1.0, 0.0)));
  EXPECT_FALSE(range_of("controller.swing.min_authority").contains(0.9));
  EXPECT_TRUE(range_of("controller.swing.min_authority").contains(std::nextafter(0.9, 0.0)));
  EXPECT_TRUE(range_of("controller.swing.min_authority").contains(0.0));
}

TEST(Range, NothingNonFiniteIsInAnyRange) {
  for (const InputDefinition& definition : input_definitions()) {
    EXPECT_FALSE(definition.range.contains(INFINITY)) << definition.name;
    EXPECT_FALSE(definition.range.contains(-INFINITY)) << definition.name;
    EXPECT_FALSE(definition.range.contains(NAN)) << definition.name;
  }
}

TEST(Range, SupportsFitWhenEveryDrawDoes) {
  const Support touching_zero{0.0, 1.0};
  const Support never_zero{0.0, INFINITY, false};
  EXPECT_FALSE(range_of("plant.m1").contains(touching_zero));
  EXPECT_TRUE(range_of("plant.m1").contains(never_zero));
  EXPECT_TRUE(range_of("plant.f1").contains(touching_zero));
  EXPECT_FALSE(range_of("plant.d2").contains(touching_zero));
  EXPECT_FALSE(range_of("plant.d2").contains(Support{-1.0, 0.0}));
  EXPECT_FALSE(range_of("plant.d2").contains(Support{-1.0, 1.0}));
  EXPECT_TRUE(range_of("plant.d2").contains(Support{-1.0, -0.1}));
  EXPECT_TRUE(range_of("plant.d2").contains(never_zero));
  EXPECT_TRUE(range_of("initial_state.q1").contains(Support{-INFINITY, INFINITY}));
  EXPECT_FALSE(range_of("controller.contraction.eta1").contains(Support{0.5, 1.0}));
  EXPECT_FALSE(range_of("controller.contraction.eta1").contains(never_zero));
}

TEST(Inputs, AreWhatTheSchemaLetsASpecCorrelate) {
  std::ifstream file(STEERSTAT_SOURCE_DIR "/schemas/study.schema.json");
  std::ostringstream text;
  text << file.rdbuf();
  const auto schema = testing::json_of(text.str());
  EXPECT_EQ(schema["$defs"]["input_name"]["enum"].get<std::vector<std::string>>(), input_names());
}

}  // namespace
}  // namespace steerstat
