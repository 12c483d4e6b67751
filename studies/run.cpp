#include "study/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "commands.hpp"
#include "core/errors.hpp"
#include "distributed/job.hpp"
#include "distributed/lead.hpp"
#include "distributed/ranks.hpp"
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
#include "study/subset_simulation.hpp"
#include "study_report.hpp"

namespace steerstat {
namespace {

constexpr const char* run_epilogue =
    R"(The summary goes to standard output as a table; progress and messages go to standard
error. Without -o the trials themselves are not kept.

After the last trial some are computed again with SUNDIALS at a hundredth of the tolerance, and the summary says how
many agree: 16, or as many as the spec's "audit" asks for. The outcomes are the same bits with every --simd.

Where the spec has gates, or with --baseline, the verdicts decide the exit code: 1 where one failed, else 3 where one
was inconclusive, else 0. Failed and inconclusive gates cost no output.

The first interrupt (Ctrl-C, SIGTERM) finishes the trials in flight, writes what is done with "complete" false and
exits 130; a second one ends at once. Until the result is in place, finished trials are kept in the directory FILE.parts
beside it, whatever happens to the process. --resume goes on from there, or from an incomplete FILE, and gives the same
bits as a run that nothing interrupted; also with more "trials" in the spec than before. Where there is nothing to go on
with, it begins at the beginning.

--shard I/N runs the I-th of N parts of the study's trials, to be put together by steerstat merge; it is neither audited
nor judged, and a "stop" in the spec is heeded by merge. It takes one process, which knows of no ranks.

A study by subset_simulation runs whole: its trials follow from those before.

Under mpirun, or srun --mpi=pmix, all ranks run the study together, each on --threads of its own, and rank 0 alone reads
the spec, reports and writes the result (where the program was built with MPI).

Examples:
  steerstat run study.json
  steerstat run study.json -o result.h5 --summary summary.json
  steerstat run study.json -o result.h5 --resume
  steerstat run study.json --junit gates.xml --baseline last_week.json
  steerstat run study.json --summary - --no-progress | jq .success_rate
  steerstat run study.json -o shard-3.h5 --shard 3/10
  mpirun -n 4 steerstat run study.json -o result.h5
  make-study | steerstat run - -o result.h5)";

struct RunRequest {
  std::string spec;
  std::optional<std::string> result;  ///< without it the trials are not kept
  StudyReport report;
  unsigned threads{0};
  std::optional<std::string> simd;   ///< without it the best that this machine runs
  std::optional<std::string> shard;  ///< I/N; without it the whole study
  bool no_progress{false};
  bool resume{false};
  Sharing sharing;
};

void check_outputs(const RunRequest& request) {
  if (request.resume && !request.result) {
    throw BadUsage(
        "--resume: without -o no trials are kept to go on with; name the result file of the interrupted run");
  }
  if (request.result == "-") {
    throw BadUsage("-o: a result file cannot go to standard output (HDF5 is not a stream); name a file");
  }
  std::vector<NamedFile> outputs = request.report.outputs();
  if (request.result) outputs.insert(outputs.begin(), {"-o", *request.result});
  std::vector<NamedFile> inputs{{"the spec", request.spec}};
  if (request.report.baseline) inputs.push_back({"the baseline", *request.report.baseline});
  check_outputs(outputs, inputs);
}

/// @throws BadUsage for what is no share, and for what only a whole study has
std::optional<StudyShare> share_of(const RunRequest& request) {
  if (!request.shard) return std::nullopt;
  const std::optional<StudyShare> share = parse_share(*request.shard);
  if (!share) {
    throw BadUsage(fmt::format("--shard: '{}' is no shard (I/N, with I from 1 to N, and N at most {}); try 1/4",
                               printable(*request.shard), readable_count(most_shares)));
  }
  if (!request.result) throw BadUsage("--shard: without -o its trials are not kept to be merged; name a file");
  if (request.report.baseline || !request.report.files.named().empty()) {
    throw BadUsage("--baseline, --junit and --markdown are of a whole study, not of a shard; give them to merge");
  }
  return share;
}

/// @throws BadUsage for a study that has to see its trials in order, where they run in several places
void require_together(const Study& study, const RunRequest& request, const Ranks* ranks) {
  if (study.store == Store::all || !study.stop || (!request.shard && ranks == nullptr)) return;
  throw BadUsage(fmt::format(
      "{}: the spec has a \"stop\" and does not store all rows (a sketch of trials beyond the stop cannot be cut where "
      "it stops); remove \"stop\", store \"all\", or run it in one process",
      request.shard ? "--shard" : "several ranks"));
}

/// @param durable  null where the trials are not kept
/// @param ranks    null where this process is alone
StudyResult run_trials(const Study& study, const RunRequest& request, InstructionSet simd,
                       const Interruption& interruption, DurableRun* durable, Ranks* ranks) {
  ProgressDisplay display(request.no_progress ? ProgressStyle::none : progress_style(), interruption.token());
  RunOptions options;
  options.threads = request.threads;
  options.simd = simd;
  options.stop = interruption.token();
  options.on_progress = [&display](const Progress& progress) { display.show(progress); };
  if (durable != nullptr) return durable->run(options, ranks, request.sharing);
  if (ranks == nullptr) return run_study(study, options);
  return completed(study, options, run_on_ranks(*ranks, study, options, {}, nullptr, request.sharing));
}

/// The kind of study that has no trials to keep.
ExitCode run_of_approximation(const ApproximationStudy& study, const RunRequest& request) {
  if (request.result) {
    throw BadUsage("-o: an approximation study keeps no trials (its cycles are no trials); use --summary FILE");
  }
  if (request.shard) throw BadUsage("--shard: an approximation study keeps no trials that could be merged");
  if (request.report.baseline || !request.report.files.named().empty()) {
    throw BadUsage("--baseline, --junit and --markdown: an approximation study has no success rate and no gates");
  }
  check_outputs(request);
  return run_approximation_study(study, request.report.summary);
}

std::optional<Baseline> read_baseline(const RunRequest& request, const Study& study) {
  if (request.report.baseline == "-" && request.spec == "-") {
    throw BadUsage("the spec and --baseline cannot both come from standard input; name a file for one of them");
  }
  return request.report.read_baseline(study);
}

/// Says that a run ended early, where it did. @return whether it did
bool tell_of_interruption(const Study& study, const RunRequest& request, const StudyResult& result) {
  const std::uint64_t finished = result.finished();
  const std::uint64_t audited = result.audit.trials.size();
  if (result.share) {
    const TrialRange range = trials_of(study, *result.share);
    const std::uint64_t requested = range.end - range.begin;
    if (finished == requested) return false;
    tell(fmt::format("interrupted after {} of {} trials of the shard", readable_count(finished),
                     readable_count(requested)));
    return true;
  }
  if (!result.complete) {
    tell(fmt::format("interrupted after {} of {} trials{}", readable_count(finished),
                     readable_count(Plan(study).trials()), request.result ? "" : "; without -o they are not kept"));
    return true;
  }
  const std::uint64_t to_audit = std::min<std::uint64_t>(study.audited_trials, finished);
  if (audited == to_audit) return false;
  tell(fmt::format("interrupted during the audit, after {} of {} trials; the study itself is complete",
                   readable_count(audited), readable_count(to_audit)));
  return true;
}

/// A study whose trials follow from those before, so that it runs whole or not at all.
///
/// @param ranks  null where this process is alone
ExitCode run_by_levels(const Study& study, const RunRequest& request, InstructionSet simd, const Ranks* ranks) {
  constexpr const char* why = "subset_simulation draws its trials from those before";
  if (request.resume) throw BadUsage(fmt::format("--resume: {}, and keeps none until the last; run it anew", why));
  if (request.shard) throw BadUsage(fmt::format("--shard: {}, so that no part can run alone; run it whole", why));
  if (ranks != nullptr) throw BadUsage(fmt::format("mpirun, srun: {}; run it in one process", why));
  if (request.report.baseline) throw BadUsage(fmt::format("--baseline: {}; use a gate on success_rate", why));
  check_outputs(request);
  if (request.result) require_writable(*request.result);
  const Interruption interruption;
  SubsetRun run;
  {
    ProgressDisplay display(request.no_progress ? ProgressStyle::none : progress_style(), interruption.token());
    RunOptions options;
    options.threads = request.threads;
    options.simd = simd;
    options.stop = interruption.token();
    options.on_progress = [&display](const Progress& progress) { display.show(progress); };
    run = run_subset_simulation(study, options);
  }
  if (run.result.trials.index.empty()) {
    tell("interrupted; a subset simulation keeps no trials until the last");
    return ExitCode::interrupted;
  }
  const bool kept = !request.result || attempt([&] { write_result(*request.result, run.study, run.result); });
  const Summary summary = summarise(run.study, run.result);
  const bool written = request.report.write(summary, kept ? request.result.value_or("") : "");
  const bool interrupted = tell_of_interruption(run.study, request, run.result);
  if (!kept || !written) return ExitCode::run_failed;
  return interrupted ? ExitCode::interrupted : exit_code_of(summary);
}

/// @param ranks  null where this process is alone
ExitCode run(const RunRequest& request, Ranks* ranks) {
  const InstructionSet simd = request.simd ? choose_simd(*request.simd) : best_instruction_set();
  const std::variant<Study, ApproximationStudy> spec = read_any_study(request.spec);
  if (const auto* approximation = std::get_if<ApproximationStudy>(&spec)) {
    return run_of_approximation(*approximation, request);
  }
  const Study& study = std::get<Study>(spec);
  if (study.sampling.method == SamplingMethod::subset_simulation) return run_by_levels(study, request, simd, ranks);
  const std::optional<StudyShare> share = share_of(request);
  require_together(study, request, ranks);
  const std::optional<Baseline> baseline = read_baseline(request, study);
  check_outputs(request);
  const Interruption interruption;  // to the end: an interrupt must not cost the outputs of a run that is over
  std::optional<DurableRun> durable;
  if (request.result) durable.emplace(*request.result, study, share, request.resume);
  const StudyResult result = run_trials(study, request, simd, interruption, durable ? &*durable : nullptr, ranks);
  Summary summary = summarise(study, result);
  if (baseline) judge_against(*baseline, study.baseline_test, summary);
  // The trials first: the most costly to lose.
  const bool kept = !durable || attempt([&] { durable->keep(result); });
  const bool written = request.report.write(summary, kept ? request.result.value_or("") : "");
  const bool interrupted = tell_of_interruption(study, request, result);
  if (!kept || !written) return ExitCode::run_failed;
  if (interrupted) return ExitCode::interrupted;
  return share ? ExitCode::done : exit_code_of(summary);  // gates are for all trials
}

/// What a rank does that does not lead: works, and says nothing.
ExitCode follow(Ranks& ranks, const RunRequest& request) {
  const Interruption interruption;
  WorkOptions options;
  options.threads = request.threads;
  options.stop = interruption.token();
  // A mistyped name is the leader's to tell; and a machine that cannot do what another can gives the same bits.
  const auto asked = request.simd ? instruction_set_named(*request.simd) : std::nullopt;
  if (asked && supports(*asked)) options.simd = *asked;
  return static_cast<ExitCode>(work(ranks, options));
}

/// Leads, and lets the other ranks end as this one does, however it does.
ExitCode lead(Ranks& ranks, const RunRequest& request) {
  const auto ended = [&ranks](ExitCode code) {
    end_ranks(ranks, static_cast<int>(code));
    return code;
  };
  try {
    return ended(run(request, &ranks));
  } catch (const BadUsage&) {
    ended(ExitCode::bad_request);
    throw;
  } catch (const BadSpec&) {
    ended(ExitCode::bad_request);
    throw;
  } catch (...) {
    ended(ExitCode::run_failed);
    throw;
  }
}

/// @throws BadUsage for what is for several processes, where there is one
void require_ranks(const RunRequest& request) {
  const char* option = request.sharing.gather ? "--gather" : request.sharing.seconds_a_range ? "--ask-every" : nullptr;
  if (option == nullptr) return;
  if (request.shard) {
    throw BadUsage(
        fmt::format("{}: a shard runs in one process, which writes its trials itself; leave it out", option));
  }
  if (!rank_in_environment()) {
    throw BadUsage(
        fmt::format("{}: this process is alone (it is for several, started by mpirun or srun); leave it out", option));
  }
}

ExitCode run_alone_or_together(const RunRequest& request) {
  require_ranks(request);
  // A shard is a run of its own, even where one command starts several.
  const std::unique_ptr<Ranks> ranks = request.shard ? nullptr : join_ranks();
  if (!ranks) return run(request, nullptr);
  return ranks->rank() == 0 ? lead(*ranks, request) : follow(*ranks, request);
}

}  // namespace

void add_run(CLI::App& program, ExitCode& exit_code) {
  CLI::App* command = program.add_subcommand("run", "Run a study and summarise it");
  const auto request = std::make_shared<RunRequest>();
  command->add_option("SPEC", request->spec, "The study's JSON file; - reads standard input")
      ->required()
      ->option_text(" ");
  command->add_option("-o,--output", request->result, "Keep the trials in this result file (HDF5)")->type_name("FILE");
  request->report.add_options(*command);
  command->add_option("--threads", request->threads, "Worker threads, 1 to 1024; one a core unless given")
      ->type_name("N")
      ->check(CLI::Range(1U, 1024U).description(""));
  command
      ->add_option("--simd", request->simd,
                   "Instruction set for lockstep: avx512, avx2 or portable; the best unless given")
      ->type_name("NAME");
  command->add_option("--shard", request->shard, "Run one of N parts of the study, for merge; the first is 1/N")
      ->type_name("I/N");
  command->add_flag("--resume", request->resume,
                    "Go on with an interrupted run into the same -o, or extend it to more trials");
  command->add_flag(
      "--gather", request->sharing.gather,
      "Under mpirun or srun: send trials to rank 0; else each rank writes beside the -o, which all share");
  command
      ->add_option("--ask-every", request->sharing.seconds_a_range,
                   "Under mpirun or srun: seconds of work that a rank is given at a time; 2 for up to 100 ranks unless "
                   "given, more for more")
      ->type_name("S")
      ->check(CLI::Range(0.001, 86400.0).description(""));
  command->add_flag("--no-progress", request->no_progress, "Do not show progress");
  command->footer(run_epilogue);
  command->callback([request, &exit_code] { exit_code = run_alone_or_together(*request); });
}

}  // namespace steerstat
