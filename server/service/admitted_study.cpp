#include "service/admitted_study.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "report/readable.hpp"
#include "service/service_errors.hpp"
#include "service/study_demand.hpp"
#include "study/plan.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

/// What a valid study asks for that the service does not grant, by place in its spec; nothing where it is taken.
std::vector<SpecError> excesses(const Study& study, const ServiceLimits& limits, std::uint64_t memory) {
  std::vector<SpecError> errors;
  if (study.store != Store::all) {
    errors.push_back({"/store", fmt::format("\"{}\" (the service answers for every trial and keeps all of their rows); "
                                            "remove it, or run the study with steerstat run",
                                            store_names[static_cast<std::size_t>(study.store)])});
  }
  const Plan plan(study);
  if (study.sampling.method == SamplingMethod::subset_simulation) {
    errors.push_back(
        {"/sampling/method",
         "subset_simulation is not run here (its trials follow from those before, so that nothing is known until the "
         "last); use importance or monte_carlo, or steerstat run"});
  }
  if (plan.trials() > limits.trials) {
    errors.push_back(
        {"/sampling/trials", fmt::format("{} trials in all cells together (at most {} here); ask for fewer",
                                         readable_count(plan.trials()), readable_count(limits.trials))});
  }
  if (plan.cells() > limits.cells) {
    errors.push_back({"", fmt::format("the sweeps make {} cells (at most {} here); sweep fewer values",
                                      readable_count(plan.cells()), readable_count(limits.cells))});
  }
  if (study.horizon > limits.horizon) {
    errors.push_back(
        {"/horizon", fmt::format("a horizon of {} s (at most {} here); shorten it", study.horizon, limits.horizon)});
  }
  const std::uint64_t needed = demand_of(study).memory;
  if (errors.empty() && needed > memory) {
    errors.push_back(
        {"/sampling/trials", fmt::format("the study needs about {} MiB of memory (at most {} here); ask for "
                                         "fewer trials or retained trajectories",
                                         needed >> 20U, memory >> 20U)});
  }
  return errors;
}

}  // namespace

Study admitted_study(std::string_view text, const ServiceLimits& limits, std::uint64_t memory) {
  if (text.size() > limits.spec_bytes) {
    throw LimitExceeded({{"", fmt::format("the spec has {} bytes (at most {} here); shorten it",
                                          readable_count(text.size()), readable_count(limits.spec_bytes))}});
  }
  Study study = decode_study(text, {});
  if (auto errors = excesses(study, limits, memory); !errors.empty()) throw LimitExceeded(std::move(errors));
  return study;
}

}  // namespace steerstat
