#include <memory>

#include "commands.hpp"
#include "output.hpp"
#include "report/summary.hpp"
#include "store/result_file.hpp"

namespace steerstat {
namespace {

constexpr const char* epilogue = R"(Examples:
  steerstat show result.h5
  steerstat show result.h5 --json | jq .success_rate)";

}  // namespace

void add_show(CLI::App& program, ExitCode& exit_code) {
  struct Request {
    std::string file;
    bool json{false};
  };
  CLI::App* command = program.add_subcommand("show", "Print the summary of a result file, recomputed from its trials");
  const auto request = std::make_shared<Request>();
  command->add_option("RESULT", request->file, "The result file (.h5)")->required()->option_text(" ");
  command->add_flag("--json", request->json, "Print JSON instead of a table");
  command->footer(epilogue);
  command->callback([request, &exit_code] {
    const StoredStudy stored = read_result(request->file);
    const Summary summary = summarise(stored.study, stored.result);
    print(request->json ? summary_json(summary) : summary_text(summary, wants_colour(StandardStream::output)));
    exit_code = ExitCode::done;
  });
}

}  // namespace steerstat
