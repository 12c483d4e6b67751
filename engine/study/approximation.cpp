#include "study/approximation.hpp"

#include <numbers>

#include "sampling/monte_carlo.hpp"

namespace steerstat {
namespace {

// The quadrants are each other's mirror images: q2 -> -q2 with q2_dot -> -q2_dot, and q2 -> pi - q2 with A -> -A and
// q2_dot -> -q2_dot, leave (4) and its approximation as they are. The first quadrant and all signs cover the rest.
constexpr Range first_quadrant{.low = 0.0, .high = std::numbers::pi / 2, .rule = "in (0, pi/2)"};
constexpr Range not_zero{.excludes_zero = true, .rule = "not 0"};

constexpr std::array<InputDefinition, 4> definitions_of_cycle{{{"cycle.q2", "rad", first_quadrant, nullptr},
                                                               {"cycle.q2_dot", "rad/s", not_zero, nullptr},
                                                               {"cycle.amplitude", "m", not_zero, nullptr},
                                                               {"cycle.period", "s", positive, nullptr}}};

Factorial cells_of(const std::array<InputValue, 4>& inputs) {
  std::vector<std::size_t> levels;
  for (const InputValue& input : inputs) {
    if (const auto* sweep = std::get_if<Sweep>(&input)) levels.push_back(sweep->values.size());
  }
  return Factorial(levels);
}

}  // namespace

std::span<const InputDefinition> cycle_definitions() {
  return definitions_of_cycle;
}

CyclePlan::CyclePlan(const ApproximationStudy& study)
    : inputs_(study.cycle), draws_(study.draws), cells_(cells_of(study.cycle)) {
  std::vector<std::string> drawn;
  std::size_t factors = 0;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if (std::holds_alternative<Sweep>(inputs_[i])) position_[i] = factors++;
    if (!std::holds_alternative<Distribution>(inputs_[i])) continue;
    position_[i] = drawn.size();
    drawn.emplace_back(definitions_of_cycle[i].name);
  }
  design_ = std::make_shared<MonteCarlo>(study.seed, drawn);
}

double CyclePlan::value(CycleInput input, std::uint64_t draw, std::uint64_t cell) const {
  const auto i = static_cast<std::size_t>(input);
  if (const auto* distribution = std::get_if<Distribution>(&inputs_[i])) {
    return distribution->quantile(design_->coordinate(draw, position_[i]));
  }
  if (const auto* sweep = std::get_if<Sweep>(&inputs_[i])) return sweep->values[cells_.level(cell, position_[i])];
  return std::get<double>(inputs_[i]);
}

Cycle CyclePlan::cycle(std::uint64_t draw, std::uint64_t cell) const {
  return {value(CycleInput::q2, draw, cell), value(CycleInput::q2_dot, draw, cell),
          value(CycleInput::amplitude, draw, cell), value(CycleInput::period, draw, cell)};
}

std::optional<double> CyclePlan::swept(CycleInput input, std::uint64_t cell) const {
  if (!std::holds_alternative<Sweep>(inputs_[static_cast<std::size_t>(input)])) return std::nullopt;
  return value(input, 0, cell);
}

std::vector<CycleError> run_approximation(const ApproximationStudy& study) {
  const CyclePlan plan(study);
  CycleComparison comparison(study.plant, study.tolerance);
  std::vector<CycleError> errors;
  errors.reserve(plan.cells() * plan.draws());
  for (std::uint64_t cell = 0; cell < plan.cells(); ++cell) {
    for (std::uint64_t draw = 0; draw < plan.draws(); ++draw) {
      errors.push_back(comparison.error_of(plan.cycle(draw, cell)));
    }
  }
  return errors;
}

}  // namespace steerstat
