#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "commands.hpp"
#include "core/errors.hpp"
#include "output.hpp"
#include "report/readable.hpp"
#include "store/result_file.hpp"
#include "table_text.hpp"

namespace steerstat {
namespace {

constexpr const char* export_epilogue =
    R"(One row a trial: index, cell, every value that varied, then how the trial ended.
Numbers read back to the same bits.

Examples:
  steerstat export result.h5 -o trials.csv
  steerstat export result.h5 -o - | head)";

}  // namespace

void add_export(CLI::App& program, ExitCode& exit_code) {
  struct ExportRequest {
    std::string file;
    std::string output;
  };
  CLI::App* command = program.add_subcommand("export", "Write the trials of a result file as CSV");
  const auto request = std::make_shared<ExportRequest>();
  command->add_option("RESULT", request->file, "The result file (.h5)")->required()->option_text(" ");
  command->add_option("-o,--output", request->output, "The CSV file to write; - writes standard output")
      ->required()
      ->type_name("FILE");
  command->footer(export_epilogue);
  command->callback([request, &exit_code] {
    const std::filesystem::path output(request->output);
    if (output != "-" && output.extension() != ".csv") {
      throw BadUsage(
          fmt::format("cannot export to {} (the only format is CSV); end the name in .csv", output.string()));
    }
    if (output != "-") require_writable(output);
    const StoredStudy stored = read_result(request->file);
    const std::string text = trials_csv(stored);
    if (output == "-") {
      print(text);
    } else {
      write_text(output, text);
      tell(fmt::format("wrote {} to {}", counted(stored.result.trials.index.size(), "trial"), output.string()));
    }
    if (stored.study.store != Store::all) {
      tell(fmt::format("of {} these are the ones whose rows were kept: {}those audited and those retained",
                       counted(stored.result.finished(), "trial"),
                       stored.study.store == Store::failed ? "those that failed, " : ""));
    }
    exit_code = ExitCode::done;
  });
}

}  // namespace steerstat
