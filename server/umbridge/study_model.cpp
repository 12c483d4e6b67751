#include "umbridge/study_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/errors.hpp"
#include "study/plan.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

constexpr std::array<std::string_view, 2> study_keys{"inputs", "study"};
constexpr std::array<std::string_view, 2> default_controller_inputs{"controller.contraction.eta1",
                                                                    "controller.contraction.eta2"};

std::vector<std::string> controller_inputs(const Json& config) {
  require_known_keys(config, study_keys);
  std::vector<std::string> names = named_inputs(config, default_controller_inputs);
  const auto foreign = std::find_if(names.begin(), names.end(),
                                    [](const std::string& name) { return !name.starts_with("controller."); });
  if (foreign != names.end()) {
    throw ModelRefusal(ModelRefusal::invalid_input,
                       fmt::format("config.inputs: {} is no parameter of the controller", *foreign));
  }
  return names;
}

std::vector<double> success_rate_in(const std::string& summary) {
  std::vector<SpecError> duplicates;
  const Json rate = parse_json(summary, duplicates)["success_rate"];
  std::vector<double> output;
  for (const char* key : {"estimate", "ci_low", "ci_high"}) {
    if (!rate[key].is_number()) {
      throw ModelRefusal(ModelRefusal::invalid_output, "the study has no success rate (no trial of it finished)");
    }
    output.push_back(rate[key].get<double>());
  }
  return output;
}

}  // namespace

std::size_t StudyModel::inputs(const Json& config) const {
  return controller_inputs(config).size();
}

Json StudyModel::spec_in(const Json& config) const {
  const Json study = config.value("study", Json());
  if (study.is_object()) return study;
  if (!study.is_string()) {
    throw ModelRefusal(ModelRefusal::invalid_input, "config.study: expected the id of a study or a spec");
  }
  std::vector<SpecError> duplicates;
  return parse_json(service_.spec(study.get<std::string>()), duplicates);
}

/// The study once it is over.
StudyState StudyModel::finished(StudyState state) const {
  const auto deadline = std::chrono::steady_clock::now() + patience_;
  while (!is_over(state.status)) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) {
      throw ModelRefusal(
          ModelRefusal::invalid_output,
          fmt::format("study {} is not finished after {} s; it goes on, ask again later", state.id, patience_.count()));
    }
    const auto next =
        service_.wait_for_change(state.id, state.revision, std::min(left, std::chrono::milliseconds(500)));
    if (!next) throw NoSuchStudy(state.id);
    state = *next;
  }
  return state;
}

std::vector<double> StudyModel::evaluate(std::span<const double> input, const Json& config) const {
  const std::vector<std::string> names = controller_inputs(config);
  try {
    Json spec = spec_in(config);
    static_cast<void>(decode_study(spec.dump(), {}));  // a sound spec has objects where the values go
    for (std::size_t i = 0; i < names.size(); ++i) put(spec, names[i], input[i]);
    if (Plan(decode_study(spec.dump(), {})).cells() > 1) {
      throw ModelRefusal(ModelRefusal::invalid_input, "config.study: it has sweeps (one success rate is the output)");
    }
    const StudyState state = finished(service_.submit(spec.dump()).state);
    if (state.status != StudyStatus::succeeded) {
      throw ModelRefusal(ModelRefusal::invalid_output, fmt::format("study {} {}: {}", state.id, name_of(state.status),
                                                                   state.failure.value_or("by a client")));
    }
    return success_rate_in(service_.summary(state.id).json);
  } catch (const BadSpec& bad) {
    throw ModelRefusal(ModelRefusal::invalid_input, bad.what());
  } catch (const LimitExceeded& exceeded) {
    throw ModelRefusal(ModelRefusal::invalid_input, exceeded.what());
  } catch (const NoSuchStudy& none) {
    throw ModelRefusal(ModelRefusal::invalid_input, none.what());
  }
}

}  // namespace steerstat
