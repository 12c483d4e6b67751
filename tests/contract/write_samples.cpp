// Writes what the program cannot be made to write at will: results of interrupted runs, every outcome, no trial at all,
// verdicts on a baseline, a name that no spec may have; and views of every kind.
//
//   write_contract_samples DIRECTORY
#include <filesystem>
#include <fstream>

#include "../report/sample_comparison.hpp"
#include "../store/sample_result.hpp"
#include "report/baseline.hpp"
#include "report/junit.hpp"
#include "report/summary.hpp"
#include "store/result_file.hpp"
#include "view/comparison_view.hpp"
#include "view/report_view.hpp"
#include "view/study_view.hpp"
#include "view/trial_view.hpp"

namespace {

using namespace steerstat;

void write(const std::filesystem::path& directory, const char* name, const Study& study, const StudyResult& result) {
  write_result(directory / (std::string(name) + ".h5"), study, result);
  std::ofstream(directory / (std::string(name) + ".json")) << summary_json(summarise(study, result));
}

/// Comparisons of a swept study that was interrupted, and of two single cells.
void write_comparisons(const std::filesystem::path& directory, const Study& study, const StudyResult& result,
                       const StudyResult& interrupted) {
  testing_report::Finished a{study, result, {}};
  testing_report::Finished b{study, interrupted, {}};
  testing_report::store_parameters(a);
  testing_report::store_parameters(b);
  std::ofstream(directory / "swept_comparison.json") << comparison_json(compare(a.compared(), b.compared("0.0.9")));

  a = testing_report::finished(testing_report::drawn_spec(60), 1);
  b = testing_report::finished(
      testing_report::drawn_spec(60, R"(, "horizon": 100, "controller": {"realignment": "never"})"), 2);
  std::ofstream(directory / "single_comparison.json") << comparison_json(compare(a.compared(), b.compared()));

  for (TrialOutcome& outcome : b.result.trials.outcomes) outcome.status = Status::timeout;
  std::ofstream(directory / "hopeless_comparison.json") << comparison_json(compare(a.compared(), b.compared()));
}

/// Views of every kind: of a swept study that was interrupted, of a small one that ran, of two that were compared.
void write_views(const std::filesystem::path& directory, const Study& swept, const StudyResult& interrupted) {
  const auto write_text = [&](const char* name, const std::string& text) { std::ofstream(directory / name) << text; };
  testing_report::Finished parts{swept, interrupted, {}};
  testing_report::store_parameters(parts);
  const ViewedStudy viewed{parts.study, parts.result, parts.parameters};
  write_text("swept_view.json", study_view_json(study_view(viewed), summarise(parts.study, parts.result)));
  write_text("map_view.json", success_map_json(success_map(viewed, "controller.contraction.eta1", "plant.f2")));

  const auto sought = testing_report::finished(R"({"plant": {"f2": {"uniform": [0, 0.05]}},
      "sampling": {"method": "importance", "trials": 90,
                   "proposal": {"components": [{"inputs": {"plant.f2": {"shift": 2}}}]}}})");
  write_text("sought_view.json", study_view_json(study_view({sought.study, sought.result, sought.parameters}),
                                                 summarise(sought.study, sought.result)));

  const auto a = testing_report::finished(testing_report::drawn_spec(70), 1);
  const auto b = testing_report::finished(testing_report::drawn_spec(70, R"(, "horizon": 100)"), 2);
  write_text("comparison_view.json", comparison_view_json(comparison_view(a.compared(), b.compared())));

  // The outcomes of a report's trials are checked, so that they must be true.
  auto ran = testing_report::finished(R"({"plant": {"f2": {"uniform": [0, 0.04]}}, "sampling": {"trials": 2}})");
  for (std::size_t row = 0; row < 2; ++row) {
    const TrialParameters parameters = Plan(ran.study).parameters(row);
    ran.result.trials.outcomes[row] = replay(parameters, ran.study.integrator).outcome;
    if (row > 0) continue;
    const Trajectory trajectory = replay_for_view(parameters, ran.study.integrator);
    write_text("trial_view.json", trial_view_json(trial_view(ran.study, row, parameters, trajectory, 100)));
  }
  const Study robust = decode_study(R"({"controller": {"policy": "robust"}})", {});
  const TrialParameters of_robust = Plan(robust).parameters(0);
  write_text("robust_trial_view.json",
             trial_view_json(trial_view(robust, 0, of_robust, replay_for_view(of_robust, robust.integrator), 100)));

  ReportOptions options;
  options.file = "of <no> consequence.h5";
  options.created = "2001-05-21T00:00:00Z";
  options.failed = options.converged = 1;
  options.trial_points = 40;
  const Summary summary = summarise(ran.study, ran.result);
  write_text("report_view.json", report_of({ran.study, ran.result, ran.parameters}, summary, options).document);
}

}  // namespace

int main(int, char** arguments) {
  const std::filesystem::path directory(arguments[1]);
  std::filesystem::create_directories(directory);
  const Study study = testing_store::sample_study(50);

  StudyResult every_outcome = testing_store::made_up_result(study);
  write(directory, "every_outcome", study, every_outcome);

  StudyResult interrupted = every_outcome;
  interrupted.complete = false;
  interrupted.trials.index.erase(interrupted.trials.index.begin() + 20, interrupted.trials.index.begin() + 110);
  interrupted.trials.outcomes.erase(interrupted.trials.outcomes.begin() + 20,
                                    interrupted.trials.outcomes.begin() + 110);
  write(directory, "interrupted", study, interrupted);

  write_comparisons(directory, study, every_outcome, interrupted);
  write_views(directory, study, interrupted);

  Summary judged = summarise(study, interrupted);
  Baseline baseline;
  baseline.converged = {90, 99};
  for (const Summary::Cell& cell : judged.cells) baseline.cells.push_back({cell.sweep, {30, 33}});
  judge_against(baseline, {}, judged);
  std::ofstream(directory / "judged.json") << summary_json(judged);

  judged.name = "control \x01 \x1f, no character \xEF\xBF\xBE, not UTF-8 \xC3(, <markup> & \"quotes\"";
  for (const Verdict verdict : {Verdict::pass, Verdict::fail, Verdict::inconclusive}) {
    judged.gates.push_back({"success_rate", "ci_low > 0.5", {}, 0.6, {0.5, 0.7}, verdict, "because ]]> & \t\n so"});
  }
  std::ofstream(directory / "judged.xml") << junit_xml(judged);

  StudyResult nothing;
  nothing.threads = 1;
  write(directory, "nothing", study, nothing);
}
