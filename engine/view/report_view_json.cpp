#include <algorithm>

#include "view/columns_json.hpp"
#include "view/report_view.hpp"
#include "view/study_view.hpp"
#include "view/trial_view.hpp"

namespace steerstat {
namespace {

constexpr std::size_t most_maps = 45;  // of ten inputs

/// Rows to replay: of the trials that the page shows as points, so that they can be clicked, failed ones first.
std::vector<std::size_t> rows_to_replay(const ViewedStudy& viewed, const StudyView::Sample& sample,
                                        const ReportOptions& options) {
  const std::vector<std::uint64_t>& index = viewed.result.trials.index;
  std::vector<std::size_t> rows;
  const auto take = [&](bool converged, std::size_t most) {
    for (std::size_t i = 0; i < sample.index.size() && most > 0; ++i) {
      if ((sample.status[i] == Status::converged) != converged) continue;
      rows.push_back(
          static_cast<std::size_t>(std::lower_bound(index.begin(), index.end(), sample.index[i]) - index.begin()));
      --most;
    }
  };
  take(false, options.failed);
  take(true, options.converged);
  return rows;
}

/// The view of the trial in `row`; nothing where its replay ends differently.
std::optional<std::string> replayed(const ViewedStudy& viewed, const Plan& plan, std::size_t row, std::size_t points) {
  const std::uint64_t index = viewed.result.trials.index[row];
  std::vector<double> values;
  for (const std::vector<double>& column : viewed.parameters) values.push_back(column[row]);
  const TrialParameters parameters = plan.parameters_with(index, values);
  const Trajectory trajectory = replay_for_view(parameters, viewed.study.integrator);
  if (!bears_out(trajectory.outcome, viewed.result.trials.outcomes[row])) return std::nullopt;
  std::string json = trial_view_json(trial_view(viewed.study, index, parameters, trajectory, points));
  json.pop_back();  // the line's end
  return json;
}

}  // namespace

Report report_of(const ViewedStudy& viewed, const Summary& summary, const ReportOptions& options) {
  const Plan plan(viewed.study);
  const StudyView view = study_view(viewed, {options.created, most_maps});
  std::string study = study_view_json(view, summary);
  study.pop_back();
  using view_json::Json;
  Report report;
  report.document = R"({"view":"report","version":)" + std::to_string(view_version) + R"(,"file":)" +
                    Json(options.file).dump(-1, ' ', false, Json::error_handler_t::replace) + R"(,"study":)" + study +
                    R"(,"trials":[)";
  for (const std::size_t row : rows_to_replay(viewed, view.sample, options)) {
    const std::optional<std::string> trial = replayed(viewed, plan, row, options.trial_points);
    if (!trial) {
      ++report.without_replay;
    } else if (report.document.size() + trial->size() > options.bytes) {
      ++report.without_room;
    } else {
      if (!report.trials.empty()) report.document += ',';
      report.document += *trial;
      report.trials.push_back(viewed.result.trials.index[row]);
    }
  }
  report.document += "]}";
  return report;
}

}  // namespace steerstat
