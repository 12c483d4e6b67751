#include "trial/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "core/errors.hpp"
#include "core/version.hpp"
#include "output.hpp"
#include "report/trajectory_json.hpp"
#include "store/result_file.hpp"
#include "study/plan.hpp"
#include "table_text.hpp"

namespace steerstat {
namespace {

constexpr const char* replay_epilogue =
    R"(The trial is recomputed from the parameters stored in the file, and must end in the
same bits as the stored trial, where its row was kept. Columns: t,q1,q2,q1_dot,q2_dot,a,tau,phase.

Examples:
  steerstat replay result.h5 --trial 17 | less
  steerstat replay result.h5 --trial 17 -o trial-17.json)";

struct ReplayRequest {
  std::string file;
  std::string trial;
  std::string output{"-"};
};

/// Which trial is meant. @throws BadUsage naming the trials there are
std::uint64_t index_of(const std::string& text, const StoredStudy& stored, const std::string& file) {
  const StudyResult& result = stored.result;
  const std::vector<TrialRange> known = result.sketch ? result.sketch->trials() : ranges_of(result.trials.index);
  if (known.empty()) throw BadUsage(fmt::format("{} holds no trials: its run was interrupted before the first", file));
  std::uint64_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  const bool number = error == std::errc() && end == text.data() + text.size();
  const auto has = [index](TrialRange range) { return range.begin <= index && index < range.end; };
  if (number && std::any_of(known.begin(), known.end(), has)) return index;
  const std::uint64_t first = known.front().begin;
  const std::uint64_t last = known.back().end - 1;
  const std::string those =
      first == last ? fmt::format("trial {} alone", first) : fmt::format("trials {} to {}", first, last);
  throw BadUsage(fmt::format("--trial: there is no trial {} in {}; it holds {}", text, file, those));
}

/// Where its row stands, if it was kept.
std::optional<std::size_t> row_of(std::uint64_t index, const StoredStudy& stored) {
  const std::vector<std::uint64_t>& indices = stored.result.trials.index;
  const auto found = std::lower_bound(indices.begin(), indices.end(), index);
  if (found == indices.end() || *found != index) return std::nullopt;
  return static_cast<std::size_t>(found - indices.begin());
}

void require_known_format(const std::filesystem::path& output) {
  if (output == "-" || output.extension() == ".csv" || output.extension() == ".json") return;
  throw BadUsage(
      fmt::format("cannot write a trajectory to {} (unknown format); end the name in .csv or .json", output.string()));
}

void require_same_end(const TrialOutcome& now, const TrialOutcome& then, const StoredStudy& stored,
                      const std::string& file, std::uint64_t index) {
  if (bears_out(now, then)) return;
  std::string why = "the file was computed by another build or on another machine, or was changed";
  if (stored.engine_version != engine_version()) {
    why = fmt::format("the file is of engine {}, this is {}; replay it with that version", stored.engine_version,
                      engine_version());
  }
  throw RunFailure(fmt::format("trial {} of {} cannot be replayed: it ended {} at {} s, the file says {} at {} s ({})",
                               index, file, name_of(now.status), now.end_time, name_of(then.status), then.end_time,
                               why));
}

ExitCode run(const ReplayRequest& request) {
  const std::filesystem::path output(request.output);
  require_known_format(output);
  if (output != "-") require_writable(output);
  const StoredStudy stored = read_result(request.file);
  const std::uint64_t index = index_of(request.trial, stored, request.file);
  const std::optional<std::size_t> row = row_of(index, stored);

  const Plan plan(stored.study);
  std::vector<double> values(plan.varying().size());
  if (row) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = stored.parameters[i][*row];
  } else {
    plan.draw(index, values);  // the same, as the draws of a trial depend on nothing but spec and index
  }
  const Trajectory trajectory = replay(plan.parameters_with(index, values), stored.study.integrator);
  if (row) require_same_end(trajectory.outcome, stored.result.trials.outcomes[*row], stored, request.file, index);

  const std::string text = output.extension() == ".json"
                               ? trajectory_json(stored.study, index, plan.varying(), values, trajectory)
                               : trajectory_csv(trajectory);
  if (output == "-") {
    print(text);
  } else {
    write_text(output, text);
    tell(fmt::format("wrote trial {} ({} at {:.3f} s) to {}", index, name_of(trajectory.outcome.status),
                     trajectory.outcome.end_time, output.string()));
  }
  return ExitCode::done;
}

}  // namespace

void add_replay(CLI::App& program, ExitCode& exit_code) {
  CLI::App* command = program.add_subcommand("replay", "Recompute the trajectory of one trial of a result file");
  const auto request = std::make_shared<ReplayRequest>();
  command->add_option("RESULT", request->file, "The result file (.h5)")->required()->option_text(" ");
  command->add_option("--trial", request->trial, "The trial's index")->required()->type_name("I");
  command->add_option("-o,--output", request->output, "Write .csv or .json instead of CSV to standard output")
      ->type_name("FILE");
  command->footer(replay_epilogue);
  command->callback([request, &exit_code] { exit_code = run(*request); });
}

}  // namespace steerstat
