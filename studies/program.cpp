#include "program.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "commands.hpp"
#include "core/errors.hpp"
#include "core/version.hpp"
#include "distributed/ranks.hpp"
#include "output.hpp"
#include "simd_choice.hpp"
#include "study/nearest.hpp"
#include "tell_failure.hpp"

namespace steerstat {
namespace {

constexpr const char* program_epilogue = R"(Examples:
  steerstat validate study.json                  check a spec
  steerstat run study.json -o result.h5          run it, keep every trial, print the summary
  steerstat show result.h5                       print the summary again
  steerstat replay result.h5 --trial 3 -o 3.csv  the trajectory of one trial
  steerstat export result.h5 -o trials.csv       every trial as a row
  steerstat compare a.h5 b.h5                    two studies on the same draws, trial by trial
  steerstat merge shard-*.h5 -o result.h5        one study that ran as several shards
  steerstat report result.h5 -o result.html      one page of figures, to look at and to send
  steerstat serve                                the same behind an HTTP API

Exit codes: 0 done and every gate passed, 1 a gate failed, 2 bad usage or bad spec (nothing is written), 3 a gate was
inconclusive and none failed, 4 the run failed (I/O, a corrupt file), 130 interrupted, with what was finished kept.
COMMAND --help tells more.)";

std::string version() {
  return fmt::format("steerstat {}\nbuilt with {} ({}), HDF5 {}, SUNDIALS {}, oneTBB {}\n{}", engine_version(),
                     STEERSTAT_COMPILER, STEERSTAT_BUILD_TYPE, STEERSTAT_HDF5_VERSION, STEERSTAT_SUNDIALS_VERSION,
                     STEERSTAT_TBB_VERSION, simd_text());
}

/// "; did you mean X?" where a known word is near to what was typed, else "".
std::string suggestion(std::string_view typed, const std::vector<std::string>& known) {
  const std::vector<std::string_view> words(known.begin(), known.end());
  const std::optional<std::string_view> meant = nearest(typed, words);
  return meant ? fmt::format("; did you mean {}?", *meant) : "";
}

/// What is wrong with a command line that CLI11 refused with `mistake`.
std::string explanation(const CLI::App& program, const CLI::ParseError& mistake, std::string_view first) {
  std::vector<std::string> words;
  if (program.get_subcommands().empty()) {
    if (first.empty()) return "no command given";
    for (const CLI::App* command : program.get_subcommands({})) words.push_back(command->get_name());
    for (const CLI::Option* option : program.get_options()) words.push_back(option->get_name());
    return fmt::format("there is no {} {}{}", first.starts_with('-') ? "option" : "command", first,
                       suggestion(first, words));
  }
  const CLI::App* command = program.get_subcommands().front();
  const std::vector<std::string> unexpected = program.remaining(true);
  if (dynamic_cast<const CLI::ExtrasError*>(&mistake) == nullptr || unexpected.empty()) return mistake.what();
  for (const CLI::Option* option : command->get_options()) words.push_back(option->get_name());
  const std::string word = unexpected.front().substr(0, unexpected.front().find('='));
  return fmt::format("{} does not take {}{}", command->get_name(), word, suggestion(word, words));
}

/// What CLI11 has to say where parsing ended: help and version as results, mistakes as messages.
ExitCode end_of_parsing(const CLI::App& program, const CLI::ParseError& end, std::string_view first) {
  std::ostringstream out;
  std::ostringstream mistakes;
  if (program.exit(end, out, mistakes) == 0) {
    print(out.str());
    return ExitCode::done;
  }
  const auto chosen = program.get_subcommands();
  tell(explanation(program, end, first));
  tell_raw(fmt::format("Try: steerstat {}--help\n", chosen.empty() ? "" : chosen.front()->get_name() + " "));
  return ExitCode::bad_request;
}

/// Whether another process of this run says all that there is to say.
bool is_follower(int argc, const char* const* argv) {
  if (rank_in_environment().value_or(0) == 0 || argc < 2 || std::string_view(argv[1]) != "run") return false;
  return std::none_of(argv + 2, argv + argc, [](std::string_view word) { return word.starts_with("--shard"); });
}

ExitCode parse_and_run(int argc, const char* const* argv) {
  CLI::App program("Monte Carlo robustness and parameter studies of an underactuated robot's controller", "steerstat");
  ExitCode exit_code = ExitCode::done;
  program.set_version_flag("--version", version(), "Print the versions of the program and its libraries and exit");
  program.set_help_flag("-h,--help", "Print this and exit");
  program.require_subcommand(1);
  program.get_formatter()->label("SUBCOMMAND", "COMMAND");
  program.get_formatter()->label("REQUIRED", "(required)");
  program.get_formatter()->label("Positionals", "Arguments");
  program.footer(program_epilogue);
  add_run(program, exit_code);
  add_validate(program, exit_code);
  add_show(program, exit_code);
  add_replay(program, exit_code);
  add_export(program, exit_code);
  add_compare(program, exit_code);
  add_merge(program, exit_code);
  add_report(program, exit_code);
  add_serve(program, exit_code);
  for (CLI::App* command : program.get_subcommands({})) command->group("Commands");
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& end) {
    return end_of_parsing(program, end, argc > 1 ? argv[1] : "");
  }
  return exit_code;
}

}  // namespace

ExitCode run_program(int argc, const char* const* argv) noexcept {
  try {
    secure_standard_streams();
    if (is_follower(argc, argv)) mute_standard_streams();
    return parse_and_run(argc, argv);
  } catch (...) {
    return tell_failure();
  }
}

}  // namespace steerstat
