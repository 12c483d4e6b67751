#include <fmt/format.h>

#include <memory>

#include "commands.hpp"
#include "core/errors.hpp"
#include "distributed/job.hpp"
#include "distributed/lead.hpp"
#include "distributed/ranks.hpp"
#include "interruption.hpp"
#include "requested_run.hpp"
#include "simd_choice.hpp"
#include "tell_failure.hpp"

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

/// Leads, and lets the other ranks end as this one does, however it does: when all is said, for once a rank ends with a
/// code that is not 0, mpirun ends the others.
ExitCode lead(Ranks& ranks, const RunRequest& request) {
  ExitCode code = ExitCode::run_failed;
  try {
    code = run_requested(request, &ranks);
  } catch (...) {
    code = tell_failure();
  }
  end_ranks(ranks, static_cast<int>(code));
  return code;
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
  if (!ranks) return run_requested(request, nullptr);
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
