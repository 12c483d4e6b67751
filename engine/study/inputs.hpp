#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "study/study.hpp"
#include "trial/trial.hpp"

namespace steerstat {

/// Which values an input may take.
struct Range {
  double low{-std::numeric_limits<double>::infinity()};
  double high{std::numeric_limits<double>::infinity()};
  bool includes_low{false};
  bool includes_high{false};
  bool excludes_zero{false};
  std::string_view rule{"finite"};  ///< as a message says it, e.g. "> 0"

  [[nodiscard]] bool contains(double x) const;

  /// Whether every draw of a distribution with this support is in the range.
  [[nodiscard]] bool contains(const Support& support) const;
};

inline constexpr Range any_number{};
inline constexpr Range positive{.low = 0.0, .rule = "> 0"};
inline constexpr Range non_negative{.low = 0.0, .includes_low = true, .rule = ">= 0"};

/// One number of `plant`, `initial_state`, `controller`, `actuator` or `sensor`: the numbers a study can vary.
struct InputDefinition {
  std::string_view name;  ///< dotted, as in a spec: "plant.m1"
  std::string_view unit;  ///< "1" where it has none
  Range range;
  double& (*field)(TrialParameters&);  ///< where the number stands
  /// An imperfection (engine/robot/README.md) is off by default and has no nominal value; the canonical spec of a study
  /// with none of them mentions none.
  bool is_imperfection{false};
  /// The one policy whose rules read it; nothing where both do, or none. The canonical spec of a study with the other
  /// policy does not mention it.
  std::optional<Policy> policy{};

  /// The value of a spec that does not mention it (and whose nominal plant is the default one). Outside the range, as
  /// it is infinite, for actuator.max_force and controller.max_stroke alone.
  [[nodiscard]] double default_value() const;
};

/// How many inputs there are.
inline constexpr std::size_t input_count = 50;

/// Every input, in the order of the spec's documentation.
std::span<const InputDefinition> input_definitions();

/// @return the input called `name`, or nullptr.
const InputDefinition* find_input(std::string_view name);

/// The names of input_definitions().
std::vector<std::string> input_names();

/// The inputs of a spec that mentions none.
/// @param nominal  what an omitted plant value equals
std::vector<Input> default_inputs(const PlantParameters<double>& nominal);

}  // namespace steerstat
