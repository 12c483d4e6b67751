#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "commands.hpp"
#include "core/errors.hpp"
#include "output.hpp"
#include "page/embedded_page.hpp"
#include "page/report_page.hpp"
#include "report/readable.hpp"
#include "report/summary.hpp"
#include "report_files.hpp"
#include "store/result_file.hpp"
#include "view/report_view.hpp"

namespace steerstat {
namespace {

constexpr const char* report_epilogue =
    R"(One HTML file with its data inside: any browser opens it, and it asks no other host for anything. It stays below
5 MB: of more than 10,000 trials those shown one by one are a random choice, maps count all, and each says of how many.
Up to 50 failed trials and 10 that converged can be opened. Of a study that seeks failures, or keeps no rows of some
trials, it leaves out what would count trials as they come.

Example:
  steerstat report result.h5 -o result.html)";

struct ReportRequest {
  std::string file;
  std::string output;
};

ExitCode run(const ReportRequest& request) {
  const std::filesystem::path output(request.output);
  if (const PageFiles files = embedded_page(); !files.absence.empty()) throw RunFailure(missing_page(files));
  check_outputs({{"--output", request.output}}, {{"the result file", request.file}});
  const StoredStudy stored = read_result(request.file);
  const Summary summary = summarise(stored.study, stored.result);
  ReportOptions options;
  options.file = std::filesystem::path(request.file).filename().string();
  options.created = stored.created;
  const Report report = report_of({stored.study, stored.result, stored.parameters}, summary, options);
  const std::string page = report_page(embedded_page(), stored.study.name, report.document);
  write_text(output, page);
  if (report.without_replay > 0) {
    tell(
        fmt::format("{} trials do not replay to the stored bits and are left out: the file is of engine {} or of "
                    "another machine's CVODE",
                    report.without_replay, stored.engine_version));
  }
  tell(fmt::format("wrote the report on {}, {} of which can be opened, to {} ({:.1f} MB)",
                   counted(summary.completed, "trial"), report.trials.size(), output.string(),
                   static_cast<double>(page.size()) / 1e6));
  return ExitCode::done;
}

}  // namespace

void add_report(CLI::App& program, ExitCode& exit_code) {
  CLI::App* command = program.add_subcommand("report", "Write one self-contained HTML page of a result file's figures");
  const auto request = std::make_shared<ReportRequest>();
  command->add_option("RESULT", request->file, "The result file (.h5)")->required()->option_text(" ");
  command->add_option("-o,--output", request->output, "Where to write the page")->required()->type_name("HTML");
  command->footer(report_epilogue);
  command->callback([request, &exit_code] { exit_code = run(*request); });
}

}  // namespace steerstat
