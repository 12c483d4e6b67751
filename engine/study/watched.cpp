#include "study/watched.hpp"

#include "study/plan.hpp"

namespace steerstat {

PrecisionWatch watch_of(const Study& study) {
  return {study.stop.value(), study.sampling.trials, Plan(study).cells()};
}

std::optional<StopReport> watched(const Study& study, const TrialTable& trials) {
  if (!study.stop) return std::nullopt;
  PrecisionWatch watch = watch_of(study);
  for (std::uint64_t row = 0; row < trials.index.size() && trials.index[row] == row && !watch.stopped(); ++row) {
    watch.add(trials.outcomes[row]);
  }
  return watch.report();
}

std::uint64_t trials_due(const Study& study, const TrialTable& trials) {
  const std::optional<StopReport> report = watched(study, trials);
  return report && report->reason ? report->trials : Plan(study).trials();
}

std::optional<StopReport> watched(const Study& study, const TrialSketch& sketch) {
  if (!study.stop) return std::nullopt;
  PrecisionWatch watch = watch_of(study);
  watch.skip_to(sketch.cells(), sketch.count());
  return watch.report();
}

std::optional<StopReport> watched(const Study& study, const StudyResult& result) {
  return result.sketch ? watched(study, *result.sketch) : watched(study, result.trials);
}

std::uint64_t trials_due(const Study& study, const StudyResult& result) {
  const std::optional<StopReport> report = watched(study, result);
  return report && report->reason ? report->trials : Plan(study).trials();
}

}  // namespace steerstat
