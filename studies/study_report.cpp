#include "study_report.hpp"

#include <fmt/format.h>

#include "baseline_file.hpp"
#include "output.hpp"
#include "report/verdict.hpp"

namespace steerstat {

void StudyReport::add_options(CLI::App& command) {
  command.add_option("--summary", summary, "Write the summary to this file as JSON; - prints it instead of the table")
      ->type_name("FILE");
  files.add_options(command);
  command
      .add_option("--baseline", baseline, "Gate on this earlier summary too: the success rate must not have dropped")
      ->type_name("SUMMARY");
}

std::vector<NamedFile> StudyReport::outputs() const {
  std::vector<NamedFile> outputs = files.named();
  if (summary && !prints_json()) outputs.insert(outputs.begin(), {"--summary", *summary});
  return outputs;
}

std::optional<Baseline> StudyReport::read_baseline(const Study& study) const {
  if (!baseline) return std::nullopt;
  Baseline read = read_baseline_file(*baseline);
  require_same_population(study, read);
  return read;
}

bool StudyReport::write(const Summary& of_study, const std::string& trials_at) const {
  const bool to_file = summary && !prints_json();
  const bool summarised = !to_file || attempt([&] { write_text(*summary, summary_json(of_study)); });
  const bool printed = attempt([&] {
    print(prints_json() ? summary_json(of_study) : summary_text(of_study, wants_colour(StandardStream::output)));
  });
  if (!trials_at.empty()) tell(fmt::format("wrote the trials to {}", trials_at));
  if (summarised && to_file) tell(fmt::format("wrote the summary to {}", *summary));
  const bool reported = files.write(of_study);
  return summarised && printed && reported;
}

ExitCode exit_code_of(const Summary& summary) {
  switch (worst_verdict(summary.gates)) {
    case Verdict::pass:
      return ExitCode::done;
    case Verdict::fail:
      return ExitCode::check_failed;
    default:
      return ExitCode::inconclusive;
  }
}

}  // namespace steerstat
