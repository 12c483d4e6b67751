// Writes what the program cannot be made to write at will: results of interrupted runs, every outcome, no trial at all,
// verdicts on a baseline, a name that no spec may have.
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

  Summary judged = summarise(study, interrupted);
  Baseline baseline;
  baseline.converged = {90, 100};
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
