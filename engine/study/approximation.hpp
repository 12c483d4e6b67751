#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "robot/plant.hpp"
#include "sampling/design.hpp"
#include "sampling/factorial.hpp"
#include "study/inputs.hpp"
#include "study/study.hpp"
#include "trial/cycle_error.hpp"

namespace steerstat {

/// The numbers of a cycle that an approximation study can vary.
enum class CycleInput : std::uint8_t { q2, q2_dot, amplitude, period };

/// Their definitions, in the order of CycleInput: names ("cycle.q2"), units and ranges; without a field.
std::span<const InputDefinition> cycle_definitions();

/// A study of the nilpotent approximation's error, of another kind than those that stabilise: single cycles from drawn
/// states. A value; the errors are a function of it.
struct ApproximationStudy {
  static constexpr std::uint64_t most_cycles = 2'000'000;  ///< in all cells together

  std::string name{"approximation"};
  PlantParameters<double> plant{};  ///< frictionless
  std::array<InputValue, 4> cycle;  ///< by CycleInput; sweeps make cells, which share the draws
  double tolerance{1e-12};          ///< of the integration
  std::uint64_t draws{1000};        ///< a cell
  std::uint64_t seed{1};
};

/// The cycles of an approximation study. Immutable, so safe to share between threads.
class CyclePlan {
 public:
  explicit CyclePlan(const ApproximationStudy& study);

  [[nodiscard]] std::uint64_t draws() const { return draws_; }
  [[nodiscard]] std::uint64_t cells() const { return cells_.cells(); }

  /// The cycle of a draw in a cell; it depends on the seed and the draw's number, whatever else is drawn.
  [[nodiscard]] Cycle cycle(std::uint64_t draw, std::uint64_t cell) const;

  /// The value of a swept input in a cell; nothing where it is not swept.
  [[nodiscard]] std::optional<double> swept(CycleInput input, std::uint64_t cell) const;

 private:
  [[nodiscard]] double value(CycleInput input, std::uint64_t draw, std::uint64_t cell) const;

  std::array<InputValue, 4> inputs_;
  std::array<std::size_t, 4> position_{};  // in the design, or in the factorial
  std::uint64_t draws_;
  Factorial cells_;
  std::shared_ptr<const Design> design_;
};

/// The errors of all cycles.
/// @return (cells x draws), a cell's draws together
/// @throws RunFailure where an integration fails
std::vector<CycleError> run_approximation(const ApproximationStudy& study);

}  // namespace steerstat
