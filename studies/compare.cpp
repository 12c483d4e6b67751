#include <fmt/format.h>

#include <memory>

#include "all_rows.hpp"
#include "commands.hpp"
#include "output.hpp"
#include "report/comparison.hpp"
#include "store/result_file.hpp"

namespace steerstat {
namespace {

constexpr const char* compare_epilogue =
    R"(Pairs the trials of two result files that are of the same draws and differ in what is
to be compared: a controller parameter, the realignment, the nominal plant, a fixed plant value, the goal, the
integrator. Refused with exit code 2 and every reason: another seed or sampling method, other drawn inputs or
distributions, other sweeps. Where one file has more trials, those that both have are paired. Differences are B less A.

Examples:
  steerstat compare a.h5 b.h5
  steerstat compare a.h5 b.h5 --json | jq .discordant.a_only.indices)";

struct CompareRequest {
  std::string a;
  std::string b;
  bool json{false};
  std::uint64_t listed{5};
};

ComparedStudy compared(const StoredStudy& stored) {
  return {stored.study, stored.result, stored.parameters, stored.engine_version};
}

ExitCode run(const CompareRequest& request) {
  const StoredStudy a = read_result(request.a);
  const StoredStudy b = read_result(request.b);
  require_all_rows(a, request.a, "a comparison, trial by trial,");
  require_all_rows(b, request.b, "a comparison, trial by trial,");
  const Comparison comparison = compare(compared(a), compared(b));
  print(request.json
            ? comparison_json(comparison)
            : comparison_text(comparison, request.a, request.b, request.listed, wants_colour(StandardStream::output)));
  return ExitCode::done;
}

}  // namespace

void add_compare(CLI::App& program, ExitCode& exit_code) {
  CLI::App* command = program.add_subcommand("compare", "Compare two result files trial by trial, on the same draws");
  const auto request = std::make_shared<CompareRequest>();
  command->add_option("A", request->a, "The one result file (.h5)")->required()->option_text(" ");
  command->add_option("B", request->b, "The other")->required()->option_text(" ");
  command->add_flag("--json", request->json, "Print JSON instead of text");
  command->add_option("--list", request->listed, "List this many discordant trials each way; 5 unless given")
      ->type_name("N")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{most_discordant_indices}).description(""));
  command->footer(compare_epilogue);
  command->callback([request, &exit_code] { exit_code = run(*request); });
}

}  // namespace steerstat
