#include "study/rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "control/cycle.hpp"
#include "robot/plant.hpp"
#include "study/inputs.hpp"
#include "study/limits.hpp"

namespace steerstat {
namespace {

struct Interval {
  double low;
  double high;
};

class Rules {
 public:
  Rules(const Study& study, const std::vector<std::string>& mistaken, std::vector<SpecError>& errors)
      : study_(study), mistaken_(mistaken), errors_(errors) {}

  void check_coupling() {
    if (is_mistaken("nominal")) return;
    const double k = coupling(study_.nominal);
    if (std::isfinite(k) && k * k * beta > 0.0 && std::isfinite(constants_of(study_.nominal).mass)) return;
    errors_.push_back({"/nominal", fmt::format("the coupling K = m2 d2 / (I2 + m2 d2^2) comes to {} (K^2 must be a "
                                               "positive double); bring the values closer to 1",
                                               k)});
  }

  // Rule 2 of the supervisor would align for ever.
  void check_tolerances() {
    static const std::string align = "controller.alignment.tolerance";
    static const std::string active = "controller.convergence.active_tolerance";
    if (is_mistaken(align) || is_mistaken(active)) return;
    if (is_mistaken("sampling") && study_.sampling.method == SamplingMethod::explicit_trials) return;
    const auto align_column = column_of(align);
    const auto active_column = column_of(active);
    const auto refuse = [&](std::string pointer, std::string_view where, double low, double high) {
      errors_.push_back({std::move(pointer), fmt::format("{}the active error would have to be within {}, but alignment "
                                                         "stops at {} (convergence.active_tolerance >= "
                                                         "alignment.tolerance in every trial); raise the former or "
                                                         "lower the latter",
                                                         where, low, high)});
    };
    if (!align_column && !active_column) {
      const double high = values_of(align).high;
      const double low = values_of(active).low;
      if (low < high) refuse(pointer_to(active), "", low, high);
      return;
    }
    for (std::size_t row = 0; row < study_.sampling.trials; ++row) {
      const double high = align_column ? listed(row, *align_column) : values_of(align).high;
      const double low = active_column ? listed(row, *active_column) : values_of(active).low;
      if (low < high) refuse("/sampling", fmt::format("in trial {} ", row), low, high);
    }
  }

  // A number that no rule reads would look like one that makes no difference.
  void check_policy() {
    if (is_mistaken("controller.policy")) return;
    const auto refuse = [&](const std::string& pointer, const std::string& name, Policy reader) {
      errors_.push_back({pointer, fmt::format("the policy \"{}\" does not read {} (it is of the policy \"{}\" alone); "
                                              "remove it, or choose that policy",
                                              name_of(study_.policy), name, name_of(reader))});
    };
    for (const Input& input : study_.inputs) {
      const InputDefinition& definition = *find_input(input.name);
      if (definition.policy.value_or(study_.policy) == study_.policy) continue;
      const auto* number = std::get_if<double>(&input.value);
      const bool is_set = number == nullptr || *number != definition.default_value();
      if (is_set && !is_mistaken(input.name)) refuse(pointer_to(input.name), input.name, *definition.policy);
      if (column_of(input.name) && !is_mistaken("sampling")) refuse("/sampling", input.name, *definition.policy);
    }
    if (study_.policy != Policy::paper && study_.realignment != Realignment::after_cycle) {
      refuse("/controller/realignment", "controller.realignment", Policy::paper);
    }
  }

  // The stroke is a metric.
  void check_stroke() {
    static const std::string stroke = "controller.max_stroke";
    if (study_.integrator.metrics || is_mistaken(stroke)) return;
    const bool is_listed = column_of(stroke).has_value();
    if (!is_listed && !(values_of(stroke).low < std::numeric_limits<double>::infinity())) return;
    errors_.push_back({is_listed ? "/sampling" : pointer_to(stroke),
                       "a stroke limit in a study without metrics (the stroke is one of them); remove \"metrics\": "
                       "false"});
  }

  void check_sampling() {
    if (is_mistaken("sampling")) return;
    const SamplingMethod method = study_.sampling.method;
    for (const Input& input : study_.inputs) {
      const bool is_listed = column_of(input.name).has_value();
      if (std::holds_alternative<Distribution>(input.value) && method == SamplingMethod::grid) {
        errors_.push_back({pointer_to(input.name),
                           "a distribution in a grid (a grid runs the sweeps' combinations and "
                           "draws nothing); use a sweep, or the method monte_carlo"});
      } else if (std::holds_alternative<Distribution>(input.value) && method == SamplingMethod::explicit_trials) {
        errors_.push_back({pointer_to(input.name),
                           fmt::format("a distribution beside explicit trials (they draw nothing); list {} in every "
                                       "trial, or give a number",
                                       input.name)});
      } else if (std::holds_alternative<Sweep>(input.value) && method == SamplingMethod::sobol_indices) {
        errors_.push_back({pointer_to(input.name),
                           "a sweep beside sobol_indices (every input that varies is drawn); use a distribution, "
                           "such as a discrete one, or a study for each value"});
      } else if (std::holds_alternative<Sweep>(input.value) && is_listed) {
        errors_.push_back({pointer_to(input.name), fmt::format("{} is swept and listed in the explicit trials too (one "
                                                               "source of values); remove one",
                                                               input.name)});
      }
    }
    if (study_.stop && !is_mistaken("stop") && method != SamplingMethod::monte_carlo) {
      errors_.push_back({"/stop", fmt::format("stopping on precision with the method {} (its intervals hold for "
                                              "independent draws, which monte_carlo alone makes); use monte_carlo, or "
                                              "remove \"stop\"",
                                              sampling_method_names[static_cast<std::size_t>(method)])});
    }
    if (method == SamplingMethod::grid && !sweeps() && mistaken_.empty()) {
      errors_.push_back({"/sampling/method",
                         "a grid without sweeps (a grid runs the sweeps' combinations); add a "
                         "{\"sweep\": [...]}, or use monte_carlo"});
    }
    if (method == SamplingMethod::sobol_indices && drawn() == 0 && mistaken_.empty()) {
      errors_.push_back({"/sampling/method",
                         "sobol_indices without a distribution (indices are those of the inputs that are drawn); add "
                         "one, such as {\"uniform\": [0.8, 1.2]}, or use monte_carlo"});
    }
  }

  // Of such trials no statistic is one of the study's distributions but the rate of failure, which has an interval of
  // its own.
  void check_seeking_of_failures() {
    const SamplingMethod method = study_.sampling.method;
    if (is_mistaken("sampling") || !seeks_failures(method)) return;
    const std::string_view name = sampling_method_names[static_cast<std::size_t>(method)];
    for (const Input& input : study_.inputs) {
      if (!std::holds_alternative<Sweep>(input.value)) continue;
      errors_.push_back({pointer_to(input.name),
                         fmt::format("a sweep beside {} (it looks for the failures of one cell); use a study for each "
                                     "value",
                                     name)});
    }
    if (drawn() == 0 && mistaken_.empty()) {
      errors_.push_back({"/sampling/method",
                         fmt::format("{} without a distribution (it draws failures more often than they are); add "
                                     "one, such as {{\"uniform\": [0.8, 1.2]}}, or use monte_carlo",
                                     name)});
    }
    for (const std::string_view key : {"q1", "q2", "q1_dot", "q2_dot"}) {
      const std::string noise = fmt::format("sensor.noise.{}", key);
      if (method != SamplingMethod::subset_simulation || is_mistaken(noise) || values_of(noise).high == 0.0) continue;
      errors_.push_back(
          {pointer_to(noise),
           fmt::format("noise beside {} (how a trial ends must follow from its inputs); remove it, or use "
                       "importance or monte_carlo",
                       name)});
    }
    if (study_.intervals.method != ProportionMethod::wilson && !study_.stop) {
      errors_.push_back(
          {"/intervals/method",
           fmt::format("{} has an interval of its own (no method but the level can be chosen); remove it", name)});
    }
    for (std::size_t i = 0; i < study_.gates.size(); ++i) {
      if (study_.gates[i].metric.empty() || study_.gates[i].metric == "success_rate") continue;
      errors_.push_back({fmt::format("/gates/{}/metric", i),
                         fmt::format("{} of the method {} (its trials are drawn where failures are, so that only "
                                     "success_rate says anything of the distributions); gate on success_rate, or use "
                                     "monte_carlo",
                                     study_.gates[i].metric, name)});
    }
  }

  void check_size() {
    check_rows();
    double cells = 1.0;
    const Input* longest = nullptr;
    std::size_t most = 0;
    for (const Input& input : study_.inputs) {
      const auto* sweep = std::get_if<Sweep>(&input.value);
      if (sweep == nullptr) continue;
      cells *= static_cast<double>(sweep->values.size());
      if (sweep->values.size() <= most) continue;
      longest = &input;
      most = sweep->values.size();
    }
    if (longest == nullptr) return;
    const auto trials = static_cast<double>(study_.sampling.trials);
    if (cells > static_cast<double>(most_cells)) {
      errors_.push_back({pointer_to(longest->name) + "/sweep",
                         fmt::format("the sweeps make {} cells in all (at most {}); shorten them", cells, most_cells)});
    } else if (cells * trials > static_cast<double>(most_trials)) {
      errors_.push_back({"/sampling/trials", fmt::format("{} trials in each of {} cells make {} (at most {} in all); "
                                                         "lower the trials or shorten the sweeps",
                                                         trials, cells, cells * trials, most_trials)});
    }
  }

 private:
  // A row of sobol_indices is as many trials as there are distributions, and two.
  void check_rows() {
    if (study_.sampling.method != SamplingMethod::sobol_indices) return;
    const auto rows = static_cast<double>(study_.sampling.trials);
    const auto variants = static_cast<double>(drawn() + 2);
    if (rows * variants <= static_cast<double>(most_trials)) return;
    errors_.push_back({"/sampling/trials",
                       fmt::format("{} rows of {} trials (two and one for each distribution) make {} (at most {} in "
                                   "all); lower the trials",
                                   rows, variants, rows * variants, most_trials)});
  }

  [[nodiscard]] std::size_t drawn() const {
    return static_cast<std::size_t>(std::count_if(study_.inputs.begin(), study_.inputs.end(), [](const Input& input) {
      return std::holds_alternative<Distribution>(input.value);
    }));
  }

  [[nodiscard]] bool is_mistaken(std::string_view name) const {
    return std::find(mistaken_.begin(), mistaken_.end(), name) != mistaken_.end();
  }

  [[nodiscard]] bool sweeps() const {
    return std::any_of(study_.inputs.begin(), study_.inputs.end(),
                       [](const Input& input) { return std::holds_alternative<Sweep>(input.value); });
  }

  [[nodiscard]] Interval values_of(const std::string& name) const {
    const auto input = std::find_if(study_.inputs.begin(), study_.inputs.end(),
                                    [&](const Input& candidate) { return candidate.name == name; });
    if (const auto* sweep = std::get_if<Sweep>(&input->value)) {
      const auto [low, high] = std::minmax_element(sweep->values.begin(), sweep->values.end());
      return {*low, *high};
    }
    if (const auto* distribution = std::get_if<Distribution>(&input->value)) {
      return {distribution->support().low, distribution->support().high};
    }
    return {std::get<double>(input->value), std::get<double>(input->value)};
  }

  [[nodiscard]] std::optional<std::size_t> column_of(const std::string& name) const {
    const auto& names = study_.sampling.explicit_names;
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) return std::nullopt;
    return static_cast<std::size_t>(found - names.begin());
  }

  [[nodiscard]] double listed(std::size_t row, std::size_t column) const {
    return study_.sampling.explicit_values[row * study_.sampling.explicit_names.size() + column];
  }

  const Study& study_;
  const std::vector<std::string>& mistaken_;
  std::vector<SpecError>& errors_;
};

}  // namespace

std::string pointer_to(const std::string& input_name) {
  std::string pointer = '/' + input_name;
  std::replace(pointer.begin(), pointer.end(), '.', '/');
  return pointer;
}

void check_rules(const Study& study, const std::vector<std::string>& mistaken, std::vector<SpecError>& errors) {
  Rules rules(study, mistaken, errors);
  rules.check_coupling();
  rules.check_tolerances();
  rules.check_policy();
  rules.check_stroke();
  rules.check_sampling();
  rules.check_seeking_of_failures();
  rules.check_size();
}

}  // namespace steerstat
