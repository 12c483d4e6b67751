#include <fmt/format.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "all_rows.hpp"
#include "commands.hpp"
#include "core/errors.hpp"
#include "output.hpp"
#include "report/readable.hpp"
#include "report/sensitivity.hpp"
#include "report/summary.hpp"
#include "report_files.hpp"
#include "store/result_file.hpp"
#include "study/nearest.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

constexpr const char* show_epilogue =
    R"(The gates are judged again from the trials, and shown; the exit code does not depend on them. A baseline is not
stored with the trials, so its verdict is not among them.

Examples:
  steerstat show result.h5
  steerstat show result.h5 --json | jq .success_rate
  steerstat show result.h5 --sensitivity --metric success --metric peak_force

--sensitivity shows, instead of the summary, the share of each output's variance that each input which varies explains
alone, with its interval; of a study of sobol_indices also the indices of its design. With correlated inputs an index
counts what the input shares with others as its own.)";

struct ShowRequest {
  std::string file;
  bool json{false};
  bool sensitivity{false};
  std::vector<std::string> metrics;
  ReportFiles reports;
};

std::vector<Metric> chosen_outputs(const std::vector<std::string>& names) {
  std::vector<Metric> outputs;
  for (const std::string& name : names) {
    const std::optional<Metric> output = find_output(name);
    if (!output) {
      const auto known = output_names();
      const auto meant = nearest(name, known);
      throw BadUsage(fmt::format("--metric: there is no metric {} ({}){}", printable(name), fmt::join(known, ", "),
                                 meant ? fmt::format("; did you mean {}?", *meant) : ""));
    }
    outputs.push_back(*output);
  }
  return outputs;
}

void show_sensitivity(const ShowRequest& request, const StoredStudy& stored, std::span<const Metric> outputs) {
  const Plan plan(stored.study);
  SensitivityReport report;
  report.id = study_id(stored.study);
  report.name = stored.study.name;
  report.complete = stored.result.complete;
  report.given_data = given_data_sensitivity(stored.study, stored.result, stored.parameters, outputs);
  report.sobol = sobol_sensitivity(stored.study, plan, stored.result.trials);
  print(request.json ? sensitivity_json(report) : sensitivity_text(report, wants_colour(StandardStream::output)));
}

ExitCode show(const ShowRequest& request) {
  if (!request.metrics.empty() && !request.sensitivity) {
    throw BadUsage("--metric chooses what --sensitivity is of; add --sensitivity");
  }
  const auto outputs =
      chosen_outputs(request.metrics.empty() ? std::vector<std::string>{"success", "settling_time"} : request.metrics);
  if (request.sensitivity && !request.reports.named().empty()) {
    throw BadUsage(request.reports.named().front().option + " writes what the summary says; leave --sensitivity out");
  }
  check_outputs(request.reports.named(), {{"the result file", request.file}});
  const StoredStudy stored = read_result(request.file);
  if (request.sensitivity && seeks_failures(stored.study.sampling.method)) {
    throw BadUsage(
        "--sensitivity: the trials are drawn where failures are (indices are those of the study's own distributions); "
        "use monte_carlo");
  }
  if (request.sensitivity) {
    require_all_rows(stored, request.file, "--sensitivity, which bins them by their inputs,");
    show_sensitivity(request, stored, outputs);
    return ExitCode::done;
  }
  const Summary summary = summarise(stored.study, stored.result);
  print(request.json ? summary_json(summary) : summary_text(summary, wants_colour(StandardStream::output)));
  return request.reports.write(summary) ? ExitCode::done : ExitCode::run_failed;
}

}  // namespace

void add_show(CLI::App& program, ExitCode& exit_code) {
  CLI::App* command = program.add_subcommand("show", "Print the summary of a result file, recomputed from its trials");
  const auto request = std::make_shared<ShowRequest>();
  command->add_option("RESULT", request->file, "The result file (.h5)")->required()->option_text(" ");
  command->add_flag("--json", request->json, "Print JSON instead of a table");
  command->add_flag("--sensitivity", request->sensitivity, "Which input drives success and settling time");
  command
      ->add_option("--metric", request->metrics,
                   "What --sensitivity is of: success, end_time or a metric of the summary; repeatable")
      ->type_name("NAME")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  request->reports.add_options(*command);
  command->footer(show_epilogue);
  command->callback([request, &exit_code] { exit_code = show(*request); });
}

}  // namespace steerstat
