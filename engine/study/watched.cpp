#include "study/watched.hpp"

#include "study/plan.hpp"

namespace steerstat {
namespace {

std::uint64_t trials_left_by(const Study& study, const std::optional<StopReport>& report) {
  return report && report->reason ? report->trials : Plan(study).trials();
}

}  // namespace

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
  return trials_left_by(study, watched(study, trials));
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
  return trials_left_by(study, watched(study, result));
}

}  // namespace steerstat
