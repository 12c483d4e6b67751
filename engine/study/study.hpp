#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "control/controller.hpp"
#include "control/goal.hpp"
#include "robot/plant.hpp"
#include "sampling/distribution.hpp"
#include "statistics/proportion.hpp"
#include "study/gate.hpp"
#include "study/stop_rule.hpp"
#include "trial/runner.hpp"

namespace steerstat {

/// The values an input takes in turn; every sweep multiplies the cells.
struct Sweep {
  std::vector<double> values;  ///< at least one
  friend bool operator==(const Sweep&, const Sweep&) = default;
};

/// What a spec says of one number.
using InputValue = std::variant<double, Distribution, Sweep>;

/// One number of `plant`, `initial_state`, `controller`, `actuator` or `sensor`.
struct Input {
  std::string name;  ///< dotted, as in a spec: "plant.m1", "controller.contraction.eta1"
  InputValue value;
  friend bool operator==(const Input&, const Input&) = default;
};

enum class SamplingMethod : std::uint8_t {
  monte_carlo,
  latin_hypercube,
  sobol,
  grid,
  explicit_trials,
  sobol_indices,
  importance,
  subset_simulation
};

/// As a spec spells them.
inline constexpr std::array<std::string_view, 8> sampling_method_names{
    "monte_carlo", "latin_hypercube", "sobol", "grid", "explicit", "sobol_indices", "importance", "subset_simulation"};

/// Whether the method draws values from distributions.
constexpr bool draws(SamplingMethod method) {
  return method != SamplingMethod::grid && method != SamplingMethod::explicit_trials;
}

/// Whether the method draws where failures are rather than where trials are: what its trials count for is not 1, and
/// of the summary only the rate of failure says anything of the study's distributions.
constexpr bool seeks_failures(SamplingMethod method) {
  return method == SamplingMethod::importance || method == SamplingMethod::subset_simulation;
}

/// What the rows of the method sobol_indices are drawn by.
enum class SobolIndicesBase : std::uint8_t { monte_carlo, sobol };

/// How two inputs with distributions go together: the correlation of the normal variables behind them.
struct Correlation {
  std::string first;  ///< before `second` in the order of input_names()
  std::string second;
  double coefficient;  ///< in (-1, 1), not 0
  friend bool operator==(const Correlation&, const Correlation&) = default;
};

/// What the method importance draws from: the distributions themselves, with the share `nominal`, and components that
/// move the normal variables behind them (sampling/importance.hpp).
struct Proposal {
  struct Tilt {
    std::string input;  ///< with a distribution
    double shift{0.0};  ///< [standard deviations]
    double scale{1.0};  ///< > 0
    friend bool operator==(const Tilt&, const Tilt&) = default;
  };
  struct Component {
    double share{1.0};        ///< > 0, of what the nominal share leaves: relative to the other components'
    std::vector<Tilt> tilts;  ///< in the order of input_names()
    friend bool operator==(const Component&, const Component&) = default;
  };
  double nominal{0.5};  ///< in [0.1, 1)
  std::vector<Component> components;
  friend bool operator==(const Proposal&, const Proposal&) = default;
};

/// How the inputs' values are drawn.
struct Sampling {
  SamplingMethod method{SamplingMethod::monte_carlo};
  std::uint64_t trials{1};  ///< draws a cell; 1 for a grid; rows for sobol_indices; a level's states for
                            ///< subset_simulation, a multiple of 10
  std::uint64_t seed{1};
  std::vector<Correlation> correlations;  ///< in the order of input_names(); positive definite
  SobolIndicesBase base{SobolIndicesBase::monte_carlo};
  std::uint64_t levels{10};  ///< subset_simulation: at most; the first one included
  Proposal proposal;         ///< importance: with a component at least
  /// Of the method explicit, the inputs that the rows set; of a subset simulation that has run, those that are drawn.
  std::vector<std::string> explicit_names;
  std::vector<double> explicit_values;  ///< (trials that there are x explicit_names), row by row

  friend bool operator==(const Sampling&, const Sampling&) = default;
};

/// Which trials' trajectories the result file keeps.
struct Retention {
  std::uint64_t failed{0};  ///< the first this many that did not converge, by index
  std::uint64_t first{0};   ///< the first this many of all
  friend bool operator==(const Retention&, const Retention&) = default;
};

/// Of which trials a study keeps the rows. Statistics are of all trials in any case: of a study that does not keep all
/// rows, from sketches of them (TrialSketch).
enum class Store : std::uint8_t {
  all,
  failed,   ///< those that did not converge
  summary,  ///< none
};
inline constexpr std::array<std::string_view, 3> store_names{"all", "failed", "summary"};

/// Which intervals the summary gives.
struct IntervalChoice {
  ProportionMethod method{ProportionMethod::wilson};  ///< of the success rate
  double level{0.95};                                 ///< in [0.5, 0.999999], of every interval
  friend bool operator==(const IntervalChoice&, const IntervalChoice&) = default;
};

/// The intervals of a study whose spec asks for none. @param stops  whether it stops on precision
constexpr IntervalChoice default_intervals(bool stops) {
  return {stops ? ProportionMethod::confidence_sequence : ProportionMethod::wilson, 0.95};
}

/// A study: what a spec says, checked and with every default filled in. A value; the outcomes are a function of it.
struct Study {
  std::string name{"study"};
  PlantParameters<double> nominal{};
  std::vector<Input> inputs;  ///< every number that may vary, in the order of input_names()
  Policy policy{Policy::paper};
  Realignment realignment{Realignment::after_cycle};
  Goal goal{goal_at(0.0, 0.7853981633974483)};
  double horizon{300.0};  ///< [s]
  IntegratorChoice integrator{};
  Sampling sampling{};
  Retention retention{};
  Store store{Store::all};         ///< rows are also kept of trials that are audited or retained
  std::optional<StopRule> stop{};  ///< none: every trial runs
  IntervalChoice intervals{};
  std::uint64_t audited_trials{16};  ///< computed again by the reference integrator; all where there are fewer
  std::vector<Gate> gates;           ///< what the statistics must show
  BaselineTest baseline_test{};      ///< how a baseline, where one is given, is tested against

  friend bool operator==(const Study&, const Study&) = default;
};

}  // namespace steerstat
