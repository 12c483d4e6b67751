#include "study/plan.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "robot/plant.hpp"
#include "sampling/correlated_design.hpp"
#include "sampling/importance.hpp"
#include "sampling/latin_hypercube.hpp"
#include "sampling/monte_carlo.hpp"
#include "sampling/pick_freeze_design.hpp"
#include "sampling/sobol.hpp"
#include "sampling/stream.hpp"
#include "study/inputs.hpp"

namespace steerstat {
namespace {

TrialParameters fixed_parameters(const Study& study) {
  TrialParameters parameters;
  parameters.nominal = study.nominal;
  parameters.plant = study.nominal;
  parameters.goal = study.goal;
  parameters.controller.policy = study.policy;
  parameters.controller.realignment = study.realignment;
  parameters.controller.horizon = study.horizon;
  parameters.controller.coupling = coupling(study.nominal);
  return parameters;
}

const Input* find_input_of(const Study& study, const std::string& name) {
  const auto found =
      std::find_if(study.inputs.begin(), study.inputs.end(), [&](const Input& i) { return i.name == name; });
  return found == study.inputs.end() ? nullptr : &*found;
}

std::optional<std::size_t> column_of(const Sampling& sampling, const std::string& name) {
  const auto& names = sampling.explicit_names;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

Factorial cells_of(const Study& study) {
  std::vector<std::size_t> levels;
  for (const InputDefinition& definition : input_definitions()) {
    const Input* input = find_input_of(study, std::string(definition.name));
    if (input == nullptr) continue;
    if (const auto* sweep = std::get_if<Sweep>(&input->value)) levels.push_back(sweep->values.size());
  }
  return Factorial(levels);
}

std::uint64_t draws_of(const Sampling& sampling) {
  if (sampling.method == SamplingMethod::grid) return 1;
  if (sampling.method == SamplingMethod::subset_simulation && !sampling.explicit_names.empty()) {
    return sampling.explicit_values.size() / sampling.explicit_names.size();
  }
  return sampling.trials;
}

void require_known_inputs(const Study& study) {
  const auto require_known = [](const std::string& name) {
    if (find_input(name) == nullptr) throw std::invalid_argument("Plan: there is no input called " + name);
  };
  for (const Input& input : study.inputs) require_known(input.name);
  for (const std::string& name : study.sampling.explicit_names) require_known(name);
  if (study.sampling.method == SamplingMethod::explicit_trials &&
      study.sampling.explicit_values.size() != study.sampling.trials * study.sampling.explicit_names.size()) {
    throw std::invalid_argument("Plan: the explicit trials are not a full table");
  }
}

static_assert(2 * input_count <= SobolSequence::most_dimensions,
              "every input can be drawn by the method sobol, and twice for Sobol' indices");

std::shared_ptr<const Design> independent_design(const Sampling& sampling, std::span<const std::string> names) {
  if (sampling.method == SamplingMethod::latin_hypercube) {
    return std::make_shared<LatinHypercube>(sampling.trials, sampling.seed, names);
  }
  if (sampling.method == SamplingMethod::sobol) return std::make_shared<Sobol>(sampling.seed, names);
  return std::make_shared<MonteCarlo>(sampling.seed, names);
}

std::shared_ptr<const Design> pick_freeze_design(const Sampling& sampling, const std::vector<std::string>& names) {
  std::vector<std::string> base_names = names;
  for (const std::string& name : names) base_names.push_back(name + "'");  // B's draws
  Sampling base = sampling;
  base.method = sampling.base == SobolIndicesBase::sobol ? SamplingMethod::sobol : SamplingMethod::monte_carlo;
  return std::make_shared<PickFreezeDesign>(independent_design(base, base_names), names.size());
}

std::size_t drawn_position(const std::vector<std::string>& names, const std::string& name, const char* is_what) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::invalid_argument("Plan: " + name + ' ' + is_what + ", but not drawn");
  return static_cast<std::size_t>(found - names.begin());
}

std::shared_ptr<const Design> importance_design(const Sampling& sampling, const std::vector<std::string>& names) {
  double total = 0.0;
  for (const Proposal::Component& component : sampling.proposal.components) total += component.share;
  std::vector<ProposalDensity> components;
  for (const Proposal::Component& component : sampling.proposal.components) {
    ProposalDensity density{(1.0 - sampling.proposal.nominal) * (component.share / total), {}};
    for (const Proposal::Tilt& tilt : component.tilts) {
      density.tilts.push_back({drawn_position(names, tilt.input, "has a proposal"), tilt.shift, tilt.scale});
    }
    components.push_back(std::move(density));
  }
  return std::make_shared<Importance>(sampling.seed, names, std::move(components));
}

// @param names  of the inputs that are drawn
std::shared_ptr<const Design> design_of(const Sampling& sampling, const std::vector<std::string>& names) {
  if (sampling.method == SamplingMethod::sobol_indices) return pick_freeze_design(sampling, names);
  if (sampling.method == SamplingMethod::importance) return importance_design(sampling, names);
  auto independent = independent_design(sampling, names);
  if (sampling.correlations.empty()) return independent;
  std::vector<PairCorrelation> pairs;
  for (const Correlation& correlation : sampling.correlations) {
    const auto position = [&](const std::string& name) { return drawn_position(names, name, "is correlated"); };
    pairs.push_back({position(correlation.first), position(correlation.second), correlation.coefficient});
  }
  const auto factor = factorise_correlation(names.size(), pairs);
  if (!factor) throw std::invalid_argument("Plan: the correlations are not positive definite");
  return std::make_shared<CorrelatedDesign>(std::move(independent), *factor);
}

}  // namespace

Plan::Plan(const Study& study)
    : base_(fixed_parameters(study)),
      draws_(draws_of(study.sampling)),
      cells_(cells_of(study)),
      seed_(study.sampling.seed),
      listed_(study.sampling.explicit_values),
      listed_columns_(study.sampling.explicit_names.size()) {
  require_known_inputs(study);
  std::vector<std::string> drawn_names;
  std::size_t factors = 0;
  // Its trials are those that it came to; before, they are the first level's, which are plain draws.
  const bool has_run = study.sampling.method == SamplingMethod::subset_simulation && listed_columns_ > 0;
  for (const InputDefinition& definition : input_definitions()) {
    const std::string name(definition.name);
    const Input* input = find_input_of(study, name);
    std::optional<Source> source;
    const auto column = column_of(study.sampling, name);
    if (input == nullptr || (column && has_run)) {
      // stays as fixed_parameters() has it
    } else if (const auto* sweep = std::get_if<Sweep>(&input->value)) {
      source = Swept{sweep->values, factors++};
    } else if (const auto* distribution = std::get_if<Distribution>(&input->value)) {
      source = Drawn{*distribution, drawn_names.size(), distribution->relative ? definition.field(base_) : 1.0};
      drawn_names.push_back(name);
    } else {
      definition.field(base_) = std::get<double>(input->value);
    }
    if (column) {
      if (source) throw std::invalid_argument("Plan: " + name + " varies and is listed too");
      source = Listed{*column};
    }
    if (!source) continue;
    names_.push_back(name);
    fields_.push_back(definition.field);
    sources_.push_back(*std::move(source));
  }
  if (study.sampling.method == SamplingMethod::sobol_indices) {
    if (factors > 0 || drawn_names.empty() || !study.sampling.correlations.empty()) {
      throw std::invalid_argument("Plan: Sobol' indices are of independent distributions alone");
    }
    variants_ = PickFreezeDesign::variants(drawn_names.size());
    draws_ *= variants_;
  }
  design_ = design_of(study.sampling, drawn_names);
  coordinates_ = drawn_names.size();
}

double Plan::value_of(const Source& source, std::span<const double> point, std::uint64_t draw,
                      std::uint64_t cell) const {
  if (const auto* drawn = std::get_if<Drawn>(&source)) {
    return drawn->scale * drawn->distribution.quantile(point[drawn->coordinate]);
  }
  if (const auto* swept = std::get_if<Swept>(&source)) return swept->values[cells_.level(cell, swept->factor)];
  return listed_[draw * listed_columns_ + std::get<Listed>(source).column];
}

void Plan::place(std::span<const double> point, std::span<double> values) const {
  assert(point.size() == coordinates_ && values.size() == sources_.size());
  for (std::size_t i = 0; i < sources_.size(); ++i) values[i] = value_of(sources_[i], point, 0, 0);
}

void Plan::draw(std::uint64_t index, std::span<double> values) const {
  assert(index < trials() && values.size() == sources_.size());
  const std::uint64_t draw = index / cells();
  const std::uint64_t cell = index % cells();
  std::array<double, input_count> coordinates;  // NOLINT(cppcoreguidelines-pro-type-member-init): place() fills it
  const std::span<double> point(coordinates.data(), coordinates_);
  design_->place(draw, point);
  for (std::size_t i = 0; i < sources_.size(); ++i) values[i] = value_of(sources_[i], point, draw, cell);
}

TrialParameters Plan::parameters_with(std::uint64_t index, std::span<const double> values) const {
  assert(index < trials() && values.size() == fields_.size());
  TrialParameters parameters = base_;
  for (std::size_t i = 0; i < fields_.size(); ++i) fields_[i](parameters) = values[i];
  Sensor& sensor = parameters.sensor;
  if (sensor.noise != State<double>{}) {
    // By draw, so that all cells share the noise too. In a pick-freeze design it is one more input, which only B
    // varies.
    const std::uint64_t draw = index / cells();
    const auto block =
        BlockStream(seed_, draw % variants_ == 1 ? "sensor.noise'" : "sensor.noise").at(draw / variants_);
    sensor.noise_seed = (std::uint64_t{block[1]} << 32U) | block[0];
  }
  return parameters;
}

TrialParameters Plan::parameters(std::uint64_t index) const {
  std::array<double, input_count> values;  // NOLINT(cppcoreguidelines-pro-type-member-init): draw() fills what is read
  const std::span<double> varying(values.data(), fields_.size());
  draw(index, varying);
  return parameters_with(index, varying);
}

std::vector<Plan::SweptValue> Plan::sweep_values(std::uint64_t cell) const {
  std::vector<SweptValue> values;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    if (const auto* swept = std::get_if<Swept>(&sources_[i])) {
      values.push_back({names_[i], swept->values[cells_.level(cell, swept->factor)]});
    }
  }
  return values;
}

}  // namespace steerstat
