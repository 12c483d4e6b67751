#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "core/errors.hpp"
#include "interruption.hpp"
#include "output.hpp"
#include "report/readable.hpp"
#include "report/summary.hpp"
#include "store/join_shares.hpp"
#include "store/result_file.hpp"
#include "study_report.hpp"

namespace steerstat {
namespace {

constexpr const char* merge_epilogue =
    R"(Puts together what `run SPEC --shard I/N` has written for every I from 1 to N, in any order. The result is the same
as that of one run of the whole study, byte for byte in every dataset: a "stop" in the spec is heeded here, trajectories
are retained here and the audit is made here. Of its attributes, wall_s is the sum of the shards', threads the most and
simd the least of any.

Shards of another study, another engine version or another N, a shard that is named twice, one that is missing and one
that is unfinished are refused, with their names. So the shards must be all there, but for those beyond the point where
a "stop" ends the study.

Gates and --baseline decide the exit code as they do for run.

Examples:
  steerstat merge shard-*.h5 -o result.h5
  steerstat merge shards/*.h5 -o result.h5 --summary summary.json --junit gates.xml)";

struct MergeRequest {
  std::vector<std::string> shards;
  std::string result;
  StudyReport report;
  unsigned threads{0};
};

void check_merge_outputs(const MergeRequest& request) {
  if (request.result == "-") {
    throw BadUsage("-o: a result file cannot go to standard output (HDF5 is not a stream); name a file");
  }
  std::vector<NamedFile> outputs = request.report.outputs();
  outputs.insert(outputs.begin(), {"-o", request.result});
  std::vector<NamedFile> inputs;
  for (const std::string& shard : request.shards) inputs.push_back({"a shard", shard});
  if (request.report.baseline) inputs.push_back({"the baseline", *request.report.baseline});
  check_outputs(outputs, inputs);
}

/// What one run of the whole study leaves. No trial is left to run, but what a run does with finished trials is: its
/// rule, its trajectories, its audit.
StudyResult merged(JoinedShares& joined, const RunOptions& options) {
  const double wall_s = joined.finished.wall_s;
  StudyResult result = run_study(joined.study, options, std::move(joined.finished));
  result.wall_s = wall_s;
  result.threads = joined.threads;
  result.simd = joined.simd;
  return result;
}

ExitCode merge(const MergeRequest& request) {
  check_merge_outputs(request);
  const Interruption interruption;
  JoinedShares joined = join_shares(std::vector<std::filesystem::path>(request.shards.begin(), request.shards.end()));
  const Study& study = joined.study;
  const std::optional<Baseline> baseline = request.report.read_baseline(study);
  RunOptions options;
  options.threads = request.threads;
  options.stop = interruption.token();
  const StudyResult result = merged(joined, options);
  const std::uint64_t to_audit = std::min<std::uint64_t>(study.audited_trials, result.finished());
  if (result.audit.trials.size() < to_audit) {
    tell("interrupted during the audit; nothing was written, and the shards are as they were");
    return ExitCode::interrupted;
  }
  Summary summary = summarise(study, result);
  if (baseline) judge_against(*baseline, study.baseline_test, summary);
  const bool kept = attempt([&] { write_result(request.result, study, result); });
  const bool written = request.report.write(summary, kept ? request.result : "");
  return kept && written ? exit_code_of(summary) : ExitCode::run_failed;
}

}  // namespace

void add_merge(CLI::App& program, ExitCode& exit_code) {
  CLI::App* command = program.add_subcommand("merge", "Put the shards of a study together");
  const auto request = std::make_shared<MergeRequest>();
  command->add_option("SHARD", request->shards, "The result files of all its shards (.h5)")
      ->required()
      ->option_text("...");
  command->add_option("-o,--output", request->result, "The study's result file (HDF5)")->required()->type_name("FILE");
  request->report.add_options(*command);
  command->add_option("--threads", request->threads, "Threads for the audit, 1 to 1024; one a core unless given")
      ->type_name("N")
      ->check(CLI::Range(1U, 1024U).description(""));
  command->footer(merge_epilogue);
  command->callback([request, &exit_code] { exit_code = merge(*request); });
}

}  // namespace steerstat
