#include <fmt/format.h>

#include <array>
#include <future>
#include <utility>

#include "core/errors.hpp"
#include "report/summary.hpp"
#include "service/study_reader.hpp"
#include "service/study_service.hpp"
#include "study/plan.hpp"
#include "view/comparison_view.hpp"
#include "view/study_view.hpp"
#include "view/success_map.hpp"
#include "view/trial_view.hpp"

namespace steerstat {
namespace {

/// @throws BadUsage for a study whose trials are not drawn from its own distributions
void require_trials_as_they_come(const StudyEntry& entry) {
  if (!seeks_failures(entry.study->sampling.method)) return;
  throw BadUsage(fmt::format(
      "study {} draws its trials where failures are, and a map counts trials as they come; read its summary, or "
      "weigh the trials of its result file",
      entry.id));
}

/// What a view needs of a summary whose JSON was kept: none of the statistics, which take longest.
Summary outline(const Study& study, const StudyResult& result) {
  Summary summary;
  summary.requested = Plan(study).trials();
  summary.completed = result.finished();
  summary.intervals = study.intervals;
  return summary;
}

/// Whether a view takes numbers from a summary that are not shown as the summary's own.
bool draws_from_summary(const Study& study) {
  return study.sampling.method == SamplingMethod::sobol_indices || !Plan(study).sweep_values(0).empty();
}

}  // namespace

std::shared_ptr<const KeptStudy> StudyReader::everything_drawn(const StudyEntry& entry, Parameters& parameters) {
  std::shared_ptr<const KeptStudy> kept = everything(entry, &parameters);
  if (parameters.empty()) parameters = drawn_parameters(Plan(*entry.study), kept->result.trials);
  return kept;
}

StudyViews::Text StudyReader::study_view(const StudyEntry& entry) {
  const StudyState state = catalogue_.state(entry);
  return views_.view(entry.id, state.revision, state.status == StudyStatus::running, [&] {
    Parameters parameters;
    const std::shared_ptr<const KeptStudy> kept = everything_drawn(entry, parameters);
    std::optional<std::string> kept_json;
    if (state.status == StudyStatus::succeeded && !draws_from_summary(*entry.study)) kept_json = kept_summary(entry);
    // Where no summary was kept, making one takes as long as all the rest: it is made beside it.
    auto summary = std::async(std::launch::async, [&] {
      return kept_json ? outline(*entry.study, kept->result) : summarise(*entry.study, kept->result);
    });
    const StudyView view = steerstat::study_view({*entry.study, kept->result, parameters}, {state.created});
    return study_view_json(view, summary.get(), kept_json);
  });
}

std::string StudyReader::success_map(const StudyEntry& entry, std::string_view x, std::string_view y) {
  require_trials_as_they_come(entry);
  const std::lock_guard lock(comparing_);
  Parameters parameters;
  const std::shared_ptr<const KeptStudy> kept = everything_drawn(entry, parameters);
  return success_map_json(steerstat::success_map({*entry.study, kept->result, parameters}, x, y));
}

std::string StudyReader::trial_view(const StudyEntry& entry, std::uint64_t index) {
  const TrialPage page = trial(entry, index);
  const TrialRow& row = page.rows.front();
  const TrialParameters parameters = Plan(*entry.study).parameters_with(index, row.values);
  const Trajectory trajectory = replay_for_view(parameters, entry.study->integrator, within(replaying_time_));
  require_same_end(entry, index, trajectory.outcome, row.outcome);
  return trial_view_json(steerstat::trial_view(*entry.study, index, parameters, trajectory));
}

std::string StudyReader::comparison_view(const StudyEntry& a, const StudyEntry& b) {
  const std::lock_guard lock(comparing_);
  const std::array<std::shared_ptr<const KeptStudy>, 2> kept{everything(a), everything(b)};
  const auto parameters_a = drawn_parameters(Plan(*a.study), kept[0]->result.trials);
  const auto parameters_b = drawn_parameters(Plan(*b.study), kept[1]->result.trials);
  return comparison_view_json(
      steerstat::comparison_view({*a.study, kept[0]->result, parameters_a, kept[0]->engine_version},
                                 {*b.study, kept[1]->result, parameters_b, kept[1]->engine_version}));
}

}  // namespace steerstat
