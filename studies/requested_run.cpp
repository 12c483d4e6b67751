#include "requested_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <variant>

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
#include "study/run.hpp"
#include "study/subset_simulation.hpp"

namespace steerstat {
namespace {

ProgressDisplay display_of(const RunRequest& request, const Interruption& interruption) {
  return {request.no_progress ? ProgressStyle::none : progress_style(), interruption.token()};
}

/// @param display  must outlive the options
RunOptions options_of(const RunRequest& request, InstructionSet simd, const Interruption& interruption,
                      ProgressDisplay& display) {
  RunOptions options;
  options.threads = request.threads;
  options.simd = simd;
  options.stop = interruption.token();
  options.on_progress = [&display](const Progress& progress) { display.show(progress); };
  return options;
}

/// @param durable  null where the trials are not kept
/// @param ranks    null where this process is alone
StudyResult run_trials(const Study& study, const RunRequest& request, InstructionSet simd,
                       const Interruption& interruption, DurableRun* durable, Ranks* ranks) {
  ProgressDisplay display = display_of(request, interruption);
  const RunOptions options = options_of(request, simd, interruption, display);
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
    ProgressDisplay display = display_of(request, interruption);
    const RunOptions options = options_of(request, simd, interruption, display);
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

}  // namespace

ExitCode run_requested(const RunRequest& request, Ranks* ranks) {
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

}  // namespace steerstat
