#include "umbridge/trial_model.hpp"

#include <fmt/format.h>

#include <array>

#include "core/errors.hpp"
#include "service/service_errors.hpp"
#include "study/inputs.hpp"
#include "study/plan.hpp"
#include "study/spec_json.hpp"
#include "trial/runner.hpp"

namespace steerstat {
namespace {

constexpr std::array<std::string_view, 2> trial_keys{"inputs", "spec"};
constexpr std::array<std::string_view, 4> default_plant_inputs{"plant.m1", "plant.m2", "plant.f1", "plant.f2"};

Study study_of(const Json& spec) {
  try {
    return decode_study(spec.dump(), {});
  } catch (const BadSpec& bad) {
    throw ModelRefusal(ModelRefusal::invalid_input, bad.what());
  }
}

Json spec_in(const Json& config) {
  return config.contains("spec") ? config["spec"] : Json::object();
}

/// The parameters of the only trial of a study in which nothing varies.
TrialParameters parameters_of(const Study& study) {
  const Plan plan(study);
  if (!plan.varying().empty()) {
    throw ModelRefusal(
        ModelRefusal::invalid_input,
        fmt::format("config.spec: {} varies (the model's input varies, and nothing else); make it a number",
                    plan.varying().front()));
  }
  return plan.parameters(0);
}

TrialOutcome run_within(std::chrono::milliseconds patience, const IntegratorChoice& integrator,
                        const TrialParameters& parameters) {
  try {
    return make_runner(integrator)->run(parameters, within(patience));
  } catch (const TakesTooLong& slow) {
    throw ModelRefusal(ModelRefusal::invalid_output, slow.what());
  }
}

double moved(std::string_view name, double value, double x) {
  const bool relative = name.starts_with("plant.") && value != 0.0;
  return relative ? value * (1.0 + x) : value + x;
}

}  // namespace

std::size_t TrialModel::inputs(const Json& config) const {
  require_known_keys(config, trial_keys);
  return named_inputs(config, default_plant_inputs).size();
}

std::vector<double> TrialModel::evaluate(std::span<const double> input, const Json& config) const {
  require_known_keys(config, trial_keys);
  const std::vector<std::string> names = named_inputs(config, default_plant_inputs);
  Json spec = spec_in(config);
  TrialParameters undisturbed = parameters_of(study_of(spec));
  for (std::size_t i = 0; i < names.size(); ++i) {
    put(spec, names[i], moved(names[i], find_input(names[i])->field(undisturbed), input[i]));
  }
  const Study study = study_of(spec);
  if (study.horizon > longest_horizon_) {
    throw ModelRefusal(ModelRefusal::invalid_input, fmt::format("config.spec: a horizon of {} s (at most {} here)",
                                                                study.horizon, longest_horizon_));
  }
  IntegratorChoice integrator = study.integrator;
  integrator.metrics = false;  // nobody asks for them
  const TrialOutcome outcome = run_within(patience_, integrator, parameters_of(study));
  const bool converged = outcome.status == Status::converged;
  return {converged ? 1.0 : 0.0, converged ? outcome.settling_time() : study.horizon,
          static_cast<double>(outcome.cycles)};
}

}  // namespace steerstat
