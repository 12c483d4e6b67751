#include "study/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "baseline_file.hpp"
#include "commands.hpp"
#include "core/errors.hpp"
#include "durable_run.hpp"
#include "interruption.hpp"
#include "output.hpp"
#include "progress_display.hpp"
#include "report/baseline.hpp"
#include "report/readable.hpp"
#include "report/summary.hpp"
#include "report/verdict.hpp"
#include "report_files.hpp"
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

Where the spec has gates, or with --baseline, the verdicts decide the exit code: 1 where one failed, else 3 where one was
inconclusive, else 0. Failed and inconclusive gates cost no output.

The first interrupt (Ctrl-C, SIGTERM) finishes the trials in flight, writes what is done with "complete" false and
exits 130; a second one ends at once. Until the result is in place, finished trials are kept in the directory FILE.parts
beside it, whatever happens to the process. --resume goes on from there, or from an incomplete FILE, and gives the same
bits as a run that nothing interrupted; also with more "trials" in the spec than before. Where there is nothing to go on
with, it begins at the beginning.

Examples:
  steerstat run study.json
  steerstat run study.json -o result.h5 --summary summary.json
  steerstat run study.json -o result.h5 --resume
  steerstat run study.json --junit gates.xml --baseline last_week.json
  steerstat run study.json --summary - --no-progress | jq .success_rate
  make-study | steerstat run - -o result.h5)";

struct Request {
  std::string spec;
  std::optional<std::string> result;   ///< without it the trials are not kept
  std::optional<std::string> summary;  ///< "-": standard output, in the table's place
  ReportFiles reports;
  std::optional<std::string> baseline;  ///< "-": standard input
  unsigned threads{0};
  std::optional<std::string> simd;  ///< without it the best that this machine runs
  bool no_progress{false};
  bool resume{false};

  [[nodiscard]] bool prints_json() const { return summary == "-"; }
  [[nodiscard]] bool writes_summary() const { return summary && !prints_json(); }
};

void check_outputs(const Request& request) {
  if (request.resume && !request.result) {
    throw BadUsage(
        "--resume: without -o no trials are kept to go on with; name the result file of the interrupted run");
  }
  if (request.result == "-") {
    throw BadUsage("-o: a result file cannot go to standard output (HDF5 is not a stream); name a file");
  }
  std::vector<NamedFile> outputs = request.reports.named();
  if (request.writes_summary()) outputs.insert(outputs.begin(), {"--summary", *request.summary});
  if (request.result) outputs.insert(outputs.begin(), {"-o", *request.result});
  std::vector<NamedFile> inputs{{"the spec", request.spec}};
  if (request.baseline) inputs.push_back({"the baseline", *request.baseline});
  check_outputs(outputs, inputs);
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

/// Writes what was asked for, the trials first: the most costly to lose. One full disk does not take the rest along.
/// @return whether all of it was written
bool write_outputs(const Request& request, const Summary& summary, const StudyResult& result, DurableRun* durable) {
  const bool kept = durable == nullptr || attempt([&] { durable->keep(result); });
  const bool summarised =
      !request.writes_summary() || attempt([&] { write_text(*request.summary, summary_json(summary)); });
  const bool printed = attempt([&] {
    print(request.prints_json() ? summary_json(summary) : summary_text(summary, wants_colour(StandardStream::output)));
  });
  if (kept && request.result) tell(fmt::format("wrote the trials to {}", *request.result));
  if (summarised && request.writes_summary()) tell(fmt::format("wrote the summary to {}", *request.summary));
  const bool reported = request.reports.write(summary);
  return kept && summarised && printed && reported;
}

std::optional<Baseline> read_baseline(const Request& request, const Study& study) {
  if (!request.baseline) return std::nullopt;
  if (request.baseline == "-" && request.spec == "-") {
    throw BadUsage("the spec and --baseline cannot both come from standard input; name a file for one of them");
  }
  Baseline baseline = read_baseline_file(*request.baseline);
  require_same_population(study, baseline);
  return baseline;
}

ExitCode exit_code_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return ExitCode::done;
    case Verdict::fail:
      return ExitCode::check_failed;
    default:
      return ExitCode::inconclusive;
  }
}

/// The kind of study that has no trials to keep.
ExitCode run_of_approximation(const ApproximationStudy& study, const Request& request) {
  if (request.result) {
    throw BadUsage("-o: an approximation study keeps no trials (its cycles are no trials); use --summary FILE");
  }
  if (request.baseline || !request.reports.named().empty()) {
    throw BadUsage("--baseline, --junit and --markdown: an approximation study has no success rate and no gates");
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
  const std::optional<Baseline> baseline = read_baseline(request, study);
  check_outputs(request);
  const Interruption interruption;  // to the end: an interrupt must not cost the outputs of a run that is over
  std::optional<DurableRun> durable;
  if (request.result) durable.emplace(*request.result, study, request.resume);
  DurableRun* const kept = durable ? &*durable : nullptr;
  const StudyResult result = run_trials(study, request, simd, interruption, kept);
  Summary summary = summarise(study, result);
  if (baseline) judge_against(*baseline, study.baseline_test, summary);
  const bool written = write_outputs(request, summary, result, kept);
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
  if (!result.complete || audited < to_audit) return ExitCode::interrupted;
  return exit_code_of(worst_verdict(summary.gates));
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
  request->reports.add_options(*command);
  command
      ->add_option("--baseline", request->baseline,
                   "Gate on this earlier summary too: the success rate must not have dropped")
      ->type_name("SUMMARY");
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
