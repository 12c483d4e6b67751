#include "service/study_demand.hpp"

#include <algorithm>

#include "study/plan.hpp"

namespace steerstat {

StudyDemand demand_of(const Study& study) {
  constexpr std::uint64_t trajectory = std::uint64_t{512} << 10U;  // [bytes] of a long one, in memory and on the disk
  const Plan plan(study);
  const std::uint64_t trials = plan.trials();
  // A trial is an outcome and an index, each once; while the result is made, also its columns in the file's image (and
  // once more its parameters), and while it is summarised, its metrics.
  const std::uint64_t columns = sizeof(TrialOutcome) + 3 * sizeof(double);
  const std::uint64_t parameters = sizeof(double) * plan.varying().size();
  const std::uint64_t row = 2 * (sizeof(TrialOutcome) + sizeof(std::uint64_t)) + columns + 2 * parameters;
  const std::uint64_t retained = std::min(trials, study.retention.failed + study.retention.first);
  return {trials, trials * row + retained * trajectory * 2,
          trials * (2 * columns + parameters) + retained * trajectory};
}

std::optional<std::size_t> next_to_begin(std::span<const WaitingStudy> queue, std::span<const StudyDemand> running,
                                         const ServiceLimits& limits, std::uint64_t memory) {
  if (running.size() >= std::max<std::size_t>(limits.running_studies, 1)) return std::nullopt;
  const auto is_small = [&](const StudyDemand& demand) { return demand.trials <= limits.small_study; };
  const auto large = static_cast<std::size_t>(
      std::count_if(running.begin(), running.end(), [&](const StudyDemand& demand) { return !is_small(demand); }));
  const std::size_t places_for_large =
      limits.running_studies > limits.places_for_small ? limits.running_studies - limits.places_for_small : 1;
  std::uint64_t taken = 0;
  for (const StudyDemand& demand : running) taken += demand.memory;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const WaitingStudy& study = queue[i];
    if (!is_small(study.demand) && large >= places_for_large) continue;
    if (running.empty() || taken + study.demand.memory <= memory) return i;
    if (study.overtaken >= most_overtaken) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace steerstat
