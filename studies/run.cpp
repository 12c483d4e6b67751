#include "study/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "commands.hpp"
#include "core/errors.hpp"
#include "durable_run.hpp"
#include "interruption.hpp"
#include "output.hpp"
#include "progress_display.hpp"
#include "report/readable.hpp"
#include "report/summary.hpp"
#include "run_approximation.hpp"
#include "simd_choice.hpp"
#include "spec_file.hpp"
#include "store/result_file.hpp"

namespace steerstat {
namespace {

constexpr const char* epilogue = R"(The summary goes to standard output as a table; progress and messages go to standard
error. Without -o the trials themselves are not kept.

After the last trial some are computed again with SUNDIALS at a hundredth of the tolerance, and the summary says how
many agree: 16, or as many as the spec's "audit" asks for. The outcomes are the same bits with every --simd.

The first interrupt (Ctrl-C, SIGTERM) finishes the trials in flight, writes what is done with "complete" false and
exits 130; a second one ends at once. Until the result is in place, finished trials are kept in the directory FILE.parts
beside it, whatever happens to the process. --resume goes on from there, or from an incomplete FILE, and gives the same
bits as a run that nothing interrupted; also with more "trials" in the spec than before. Where there is nothing to go on
with, it begins at the beginning.

Examples:
  steerstat run study.json
  steerstat run study.json -o result.h5 --summary summary.json
  steerstat run study.json -o result.h5 --resume
  steerstat run study.json --summary - --no-progress | jq .success_rate
  make-study | steerstat run - -o result.h5)";

struct Request {
  std::string spec;
  std::optional<std::string> result;   ///< without it the trials are not kept
  std::optional<std::string> summary;  ///< "-": standard output, in the table's place
  unsigned threads{0};
  std::optional<std::string> simd;  ///< without it the best that this machine runs
  bool no_progress{false};
  bool resume{false};

  [[nodiscard]] bool prints_json() const { return summary == "-"; }
  [[nodiscard]] bool writes_summary() const { return summary && !prints_json(); }
};

bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  const std::filesystem::path first = std::filesystem::weakly_canonical(a, error);
  return !error && first == std::filesystem::weakly_canonical(b, error) && !error;
}

/// Refuses outputs that would overwrite the spec or each other, and those that cannot be written, before any trial
/// runs.
void check_outputs(const Request& request) {
  if (request.resume && !request.result) {
    throw BadUsage(
        "--resume: without -o no trials are kept to go on with; name the result file of the interrupted run");
  }
  if (request.result == "-") {
    throw BadUsage("-o: a result file cannot go to standard output (HDF5 is not a stream); name a file");
  }
  std::vector<std::string> outputs;
  if (request.result) outputs.push_back(*request.result);
  if (request.writes_summary()) outputs.push_back(*request.summary);
  for (const std::string& output : outputs) {
    if (request.spec != "-" && same_file(output, request.spec)) {
      throw BadUsage(fmt::format("{} is the spec itself and would be overwritten; name another output", output));
    }
  }
  if (outputs.size() == 2 && same_file(outputs.front(), outputs.back())) {
    throw BadUsage(fmt::format("-o and --summary both name {}; give each its own file", outputs.front()));
  }
  for (const std::string& output : outputs) require_writable(output);
}

/// @param durable  null where the trials are not kept
StudyResult run_trials(const Study& study, const Request& request, InstructionSet simd,
                       const Interruption& interruption, DurableRun* durable) {
  ProgressDisplay display(request.no_progress ? ProgressStyle::none : progress_style(), interruption.token());
  RunOptions options;
  options.threads = request.threads;
  options.simd = simd;
  options.stop = interruption.token();
  options.on_progress = [&display](const Progress& progress) { display.show(progress); };
  return durable != nullptr ? durable->run(options) : run_study(study, options);
}

/// Does one of several things of which each should be tried: a failure is told, not thrown.
/// @return whether it was done
template <class Action>
bool attempt(const Action& action) {
  try {
    action();
    return true;
  } catch (const RunFailure& failure) {
    tell(failure.what());
    return false;
  }
}

/// Writes what was asked for, the trials first: the most costly to lose. One full disk does not take the rest along.
/// @return whether all of it was written
bool write_outputs(const Request& request, const Study& study, const StudyResult& result, DurableRun* durable) {
  const Summary summary = summarise(study, result);
  const bool kept = durable == nullptr || attempt([&] { durable->keep(result); });
  const bool summarised =
      !request.writes_summary() || attempt([&] { write_text(*request.summary, summary_json(summary)); });
  const bool printed = attempt([&] {
    print(request.prints_json() ? summary_json(summary) : summary_text(summary, wants_colour(StandardStream::output)));
  });
  if (kept && request.result) tell(fmt::format("wrote the trials to {}", *request.result));
  if (summarised && request.writes_summary()) tell(fmt::format("wrote the summary to {}", *request.summary));
  return kept && summarised && printed;
}

/// The kind of study that has no trials to keep.
ExitCode run_of_approximation(const ApproximationStudy& study, const Request& request) {
  if (request.result) {
    throw BadUsage("-o: an approximation study keeps no trials (its cycles are no trials); use --summary FILE");
  }
  check_outputs(request);
  return run_approximation_study(study, request.summary);
}

ExitCode run(const Request& request) {
  const InstructionSet simd = request.simd ? choose_simd(*request.simd) : best_instruction_set();
  const std::variant<Study, ApproximationStudy> spec = read_any_study(request.spec);
  if (const auto* approximation = std::get_if<ApproximationStudy>(&spec)) {
    return run_of_approximation(*approximation, request);
  }
  const Study& study = std::get<Study>(spec);
  check_outputs(request);
  const Interruption interruption;  // to the end: an interrupt must not cost the outputs of a run that is over
  std::optional<DurableRun> durable;
  if (request.result) durable.emplace(*request.result, study, request.resume);
  DurableRun* const kept = durable ? &*durable : nullptr;
  const StudyResult result = run_trials(study, request, simd, interruption, kept);
  const bool written = write_outputs(request, study, result, kept);
  if (!result.complete) {
    tell(fmt::format("interrupted after {} of {} trials{}", readable_count(result.trials.index.size()),
                     readable_count(Plan(study).trials()), request.result ? "" : "; without -o they are not kept"));
  }
  const std::uint64_t audited = result.audit.trials.size();
  const std::uint64_t to_audit = std::min<std::uint64_t>(study.audited_trials, result.trials.index.size());
  if (result.complete && audited < to_audit) {
    tell(fmt::format("interrupted during the audit, after {} of {} trials; the study itself is complete",
                     readable_count(audited), readable_count(to_audit)));
  }
  if (!written) return ExitCode::run_failed;
  return result.complete && audited == to_audit ? ExitCode::done : ExitCode::interrupted;
}

}  // namespace

void add_run(CLI::App& program, ExitCode& exit_code) {
  CLI::App* command = program.add_subcommand("run", "Run a study and summarise it");
  const auto request = std::make_shared<Request>();
  command->add_option("SPEC", request->spec, "The study's JSON file; - reads standard input")
      ->required()
      ->option_text(" ");
  command->add_option("-o,--output", request->result, "Keep the trials in this result file (HDF5)")->type_name("FILE");
  command
      ->add_option("--summary", request->summary,
                   "Write the summary to this file as JSON; - prints it instead of the table")
      ->type_name("FILE");
  command->add_option("--threads", request->threads, "Worker threads, 1 to 1024; one a core unless given")
      ->type_name("N")
      ->check(CLI::Range(1U, 1024U).description(""));
  command
      ->add_option("--simd", request->simd,
                   "Instruction set for lockstep: avx512, avx2 or portable; the best unless given")
      ->type_name("NAME");
  command->add_flag("--resume", request->resume,
                    "Go on with an interrupted run into the same -o, or extend it to more trials");
  command->add_flag("--no-progress", request->no_progress, "Do not show progress");
  command->footer(epilogue);
  command->callback([request, &exit_code] { exit_code = run(*request); });
}

}  // namespace steerstat
