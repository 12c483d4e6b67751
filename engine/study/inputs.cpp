#include "study/inputs.hpp"

#include <array>
#include <cmath>

namespace steerstat {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr Range non_zero{.excludes_zero = true, .rule = "!= 0"};
constexpr Range fraction{.low = 0.0, .high = 1.0, .rule = "in (0, 1)"};
// Rule 6's drift ends at s2 = -(min_authority + 0.1), which has to be above -1.
constexpr Range authority{.low = 0.0, .high = 0.9, .includes_low = true, .rule = "in [0, 0.9)"};

using T = TrialParameters;
constexpr bool imperfection = true;
constexpr bool no_imperfection = false;

constexpr std::array<InputDefinition, input_count> definitions{{
    InputDefinition{"plant.m1", "kg", positive, [](T& p) -> double& { return p.plant.m1; }},
    InputDefinition{"plant.m2", "kg", positive, [](T& p) -> double& { return p.plant.m2; }},
    InputDefinition{"plant.d2", "m", non_zero, [](T& p) -> double& { return p.plant.d2; }},
    InputDefinition{"plant.I2", "kg m^2", positive, [](T& p) -> double& { return p.plant.I2; }},
    InputDefinition{"plant.f1", "N s/m", non_negative, [](T& p) -> double& { return p.plant.f1; }},
    InputDefinition{"plant.f2", "N m s/rad", non_negative, [](T& p) -> double& { return p.plant.f2; }},
    InputDefinition{"plant.coulomb1", "N", non_negative, [](T& p) -> double& { return p.disturbance.coulomb1; },
                    imperfection},
    InputDefinition{"plant.coulomb2", "N m", non_negative, [](T& p) -> double& { return p.disturbance.coulomb2; },
                    imperfection},
    InputDefinition{"plant.coulomb_speed1", "m/s", positive,
                    [](T& p) -> double& { return p.disturbance.coulomb_speed1; }, imperfection},
    InputDefinition{"plant.coulomb_speed2", "rad/s", positive,
                    [](T& p) -> double& { return p.disturbance.coulomb_speed2; }, imperfection},
    InputDefinition{"plant.gravity_x", "m/s^2", any_number, [](T& p) -> double& { return p.disturbance.gravity_x; },
                    imperfection},
    InputDefinition{"plant.gravity_y", "m/s^2", any_number, [](T& p) -> double& { return p.disturbance.gravity_y; },
                    imperfection},
    InputDefinition{"initial_state.q1", "m", any_number, [](T& p) -> double& { return p.start.q1; }},
    InputDefinition{"initial_state.q2", "rad", any_number, [](T& p) -> double& { return p.start.q2; }},
    InputDefinition{"initial_state.q1_dot", "m/s", any_number, [](T& p) -> double& { return p.start.q1_dot; }},
    InputDefinition{"initial_state.q2_dot", "rad/s", any_number, [](T& p) -> double& { return p.start.q2_dot; }},
    InputDefinition{"controller.alignment.kp", "1/s^2", positive,
                    [](T& p) -> double& { return p.controller.alignment.kp; }},
    InputDefinition{"controller.alignment.kd", "1/s", positive,
                    [](T& p) -> double& { return p.controller.alignment.kd; }},
    InputDefinition{"controller.alignment.tolerance", "m, m/s", positive,
                    [](T& p) -> double& { return p.controller.alignment.tolerance; }},
    InputDefinition{"controller.alignment.max_duration", "s", positive,
                    [](T& p) -> double& { return p.controller.alignment.max_duration; }, no_imperfection,
                    Policy::robust},
    InputDefinition{"controller.entry_fraction", "1", fraction,
                    [](T& p) -> double& { return p.controller.entry_fraction; }, no_imperfection, Policy::paper},
    InputDefinition{"controller.drift.min_speed", "rad/s", non_negative,
                    [](T& p) -> double& { return p.controller.drift.min_speed; }, no_imperfection, Policy::paper},
    InputDefinition{"controller.rest_speed", "rad/s", positive, [](T& p) -> double& { return p.controller.rest_speed; },
                    no_imperfection, Policy::paper},
    InputDefinition{"controller.swing.period", "s", positive, [](T& p) -> double& { return p.controller.swing.period; },
                    no_imperfection, Policy::paper},
    InputDefinition{"controller.swing.speed", "rad/s", positive,
                    [](T& p) -> double& { return p.controller.swing.speed; }, no_imperfection, Policy::paper},
    InputDefinition{"controller.swing.max_amplitude", "m", positive,
                    [](T& p) -> double& { return p.controller.swing.max_amplitude; }, no_imperfection, Policy::paper},
    InputDefinition{"controller.swing.min_authority", "1", authority,
                    [](T& p) -> double& { return p.controller.swing.min_authority; }},
    InputDefinition{"controller.contraction.eta1", "1", fraction,
                    [](T& p) -> double& { return p.controller.contraction.eta1; }, no_imperfection, Policy::paper},
    InputDefinition{"controller.contraction.eta2", "1", fraction,
                    [](T& p) -> double& { return p.controller.contraction.eta2; }, no_imperfection, Policy::paper},
    InputDefinition{"controller.contraction.max_period", "s", positive,
                    [](T& p) -> double& { return p.controller.contraction.max_period; }, no_imperfection,
                    Policy::paper},
    InputDefinition{"controller.convergence.tolerance", "rad, rad/s", positive,
                    [](T& p) -> double& { return p.controller.convergence.tolerance; }},
    InputDefinition{"controller.convergence.active_tolerance", "m, m/s", positive,
                    [](T& p) -> double& { return p.controller.convergence.active_tolerance; }},
    InputDefinition{"controller.robust.rate", "1/s", positive, [](T& p) -> double& { return p.controller.robust.rate; },
                    no_imperfection, Policy::robust},
    InputDefinition{"controller.robust.period", "s", positive,
                    [](T& p) -> double& { return p.controller.robust.period; }, no_imperfection, Policy::robust},
    InputDefinition{"controller.robust.alignment_time", "s", non_negative,
                    [](T& p) -> double& { return p.controller.robust.alignment_time; }, no_imperfection,
                    Policy::robust},
    InputDefinition{"controller.robust.travel_speed", "rad/s", positive,
                    [](T& p) -> double& { return p.controller.robust.travel_speed; }, no_imperfection, Policy::robust},
    InputDefinition{"controller.robust.entry_fraction", "1", fraction,
                    [](T& p) -> double& { return p.controller.robust.entry_fraction; }, no_imperfection,
                    Policy::robust},
    InputDefinition{"controller.robust.turning_angle", "rad", positive,
                    [](T& p) -> double& { return p.controller.robust.turning_angle; }, no_imperfection, Policy::robust},
    InputDefinition{"controller.robust.max_acceleration", "m/s^2", positive,
                    [](T& p) -> double& { return p.controller.robust.max_acceleration; }, no_imperfection,
                    Policy::robust},
    InputDefinition{"controller.max_stroke", "m", positive, [](T& p) -> double& { return p.controller.max_stroke; }},
    InputDefinition{"actuator.gain", "1", positive, [](T& p) -> double& { return p.actuator.gain; }, imperfection},
    InputDefinition{"actuator.max_force", "N", positive, [](T& p) -> double& { return p.actuator.max_force; },
                    imperfection},
    InputDefinition{"sensor.bias.q1", "m", any_number, [](T& p) -> double& { return p.sensor.bias.q1; }, imperfection},
    InputDefinition{"sensor.bias.q2", "rad", any_number, [](T& p) -> double& { return p.sensor.bias.q2; },
                    imperfection},
    InputDefinition{"sensor.bias.q1_dot", "m/s", any_number, [](T& p) -> double& { return p.sensor.bias.q1_dot; },
                    imperfection},
    InputDefinition{"sensor.bias.q2_dot", "rad/s", any_number, [](T& p) -> double& { return p.sensor.bias.q2_dot; },
                    imperfection},
    InputDefinition{"sensor.noise.q1", "m", non_negative, [](T& p) -> double& { return p.sensor.noise.q1; },
                    imperfection},
    InputDefinition{"sensor.noise.q2", "rad", non_negative, [](T& p) -> double& { return p.sensor.noise.q2; },
                    imperfection},
    InputDefinition{"sensor.noise.q1_dot", "m/s", non_negative, [](T& p) -> double& { return p.sensor.noise.q1_dot; },
                    imperfection},
    InputDefinition{"sensor.noise.q2_dot", "rad/s", non_negative, [](T& p) -> double& { return p.sensor.noise.q2_dot; },
                    imperfection},
}};
static_assert(definitions.back().field != nullptr, "input_count says how many there are");

}  // namespace

bool Range::contains(double x) const {
  return std::isfinite(x) && (includes_low ? x >= low : x > low) && (includes_high ? x <= high : x < high) &&
         !(excludes_zero && x == 0.0);
}

bool Range::contains(const Support& support) const {
  const bool low_inside = includes_low || !support.includes_low ? support.low >= low : support.low > low;
  const bool high_inside = includes_high || high == infinity ? support.high <= high : support.high < high;
  const bool zero_outside = support.low > 0.0 || support.high < 0.0 || (support.low == 0.0 && !support.includes_low);
  const bool unbounded_below = low == -infinity;
  return (unbounded_below || low_inside) && high_inside && (!excludes_zero || zero_outside);
}

double InputDefinition::default_value() const {
  TrialParameters parameters;
  return field(parameters);
}

std::span<const InputDefinition> input_definitions() {
  return definitions;
}

const InputDefinition* find_input(std::string_view name) {
  for (const InputDefinition& definition : definitions) {
    if (definition.name == name) return &definition;
  }
  return nullptr;
}

std::vector<std::string> input_names() {
  std::vector<std::string> names;
  names.reserve(definitions.size());
  for (const InputDefinition& definition : definitions) names.emplace_back(definition.name);
  return names;
}

std::vector<Input> default_inputs(const PlantParameters<double>& nominal) {
  TrialParameters parameters;
  parameters.plant = nominal;
  std::vector<Input> inputs;
  inputs.reserve(definitions.size());
  for (const InputDefinition& definition : definitions) {
    inputs.push_back({std::string(definition.name), definition.field(parameters)});
  }
  return inputs;
}

}  // namespace steerstat
