#include "study/run.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "core/elapsed.hpp"
#include "study/block_queue.hpp"
#include "study/finished_prefix.hpp"
#include "study/for_each.hpp"
#include "study/handover.hpp"
#include "study/progress_reports.hpp"
#include "study/recomputed.hpp"
#include "study/sketched_run.hpp"
#include "study/trial_range.hpp"
#include "study/watched.hpp"
#include "study/worker_stream.hpp"

namespace steerstat {
namespace {

/// Hands on what it takes, by the indices of the study.
class RangeSink final : public OutcomeSink {
 public:
  RangeSink(OutcomeSink& sink, std::uint64_t begin) : sink_(sink), begin_(begin) {}
  void take(std::uint64_t begin, std::span<const TrialOutcome> outcomes) override {
    sink_.take(begin_ + begin, outcomes);
  }
  void take_sketched(const FinishedTrials& piece) override { sink_.take_sketched(piece); }

 private:
  OutcomeSink& sink_;
  const std::uint64_t begin_;
};

/// Shows a sink the slots of all outcomes, as long as they are there.
class Showing {
 public:
  /// @param sink  null where nobody looks
  Showing(OutcomeSink* sink, std::span<const TrialOutcome> outcomes) : sink_(sink) {
    if (sink_ != nullptr) sink_->open(outcomes);
  }
  ~Showing() { end(); }
  Showing(const Showing&) = delete;
  Showing& operator=(const Showing&) = delete;

  void end() {
    if (OutcomeSink* const sink = std::exchange(sink_, nullptr); sink != nullptr) sink->close();
  }

 private:
  OutcomeSink* sink_;
};

/// Shows the rule the trials that were finished before the run.
void show(FinishedPrefix& prefix, std::span<const TrialRange> known, BlockQueue& blocks) {
  bool stopped = false;
  for (const TrialRange& range : known) {
    for (std::uint64_t index = range.begin; index < range.end; ++index) stopped = prefix.finished(index);
  }
  if (stopped) blocks.halt();
}

/// On so many workers, each taking a number at a time.
ForEach for_each_on(unsigned threads) {
  return [threads](std::size_t count, const std::function<void(std::size_t)>& task) {
    tbb::task_arena arena(static_cast<int>(threads));
    arena.execute([&] { tbb::parallel_for(std::size_t{0}, count, task, tbb::simple_partitioner{}); });
  };
}

/// Runs the workers until no block is left to begin. @throws what a worker threw
void work(const Study& study, const PlannedTrials& planned, const RunOptions& options, BlockQueue& blocks,
          std::vector<TrialOutcome>& outcomes, Listeners listeners, std::vector<Tally>& tallies) {
  const auto work_as = [&](std::size_t worker) {
    try {
      Turnstile::Turn turn(options.turns);
      WorkerStream stream(planned, blocks, outcomes, listeners, tallies[worker], turn, options.give_up);
      const auto runner =
          options.make_runner ? options.make_runner(study.integrator) : make_runner(study.integrator, options.simd);
      runner->run(stream);
    } catch (...) {
      blocks.halt();
      throw;  // TBB hands the first to the caller
    }
  };
  for_each_on(static_cast<unsigned>(tallies.size()))(tallies.size(), work_as);
}

/// Runs what was not finished earlier; until the watch has stopped, where there is one. Fills in the trials, counted as
/// they are planned, and their time.
/// @return the first trial that was not begun, before which all are finished
std::uint64_t run_trials(const Study& study, const PlannedTrials& planned, const RunOptions& options,
                         FinishedTrials earlier, std::optional<PrecisionWatch> watch, StudyResult& result) {
  const auto start = std::chrono::steady_clock::now();
  const std::uint64_t block = block_size(study);
  const std::vector<TrialRange> known = ranges_of(earlier.trials.index);
  std::vector<TrialOutcome> outcomes = spread(std::move(earlier.trials), planned.count());
  BlockQueue blocks(known, planned.count(), block, options.stop);
  std::optional<FinishedPrefix> prefix;
  if (watch) {
    prefix.emplace(std::move(*watch), outcomes, block);
    show(*prefix, known, blocks);
  }
  Showing showing(options.sink, outcomes);
  std::optional<HandOver> handover;
  if (options.sink != nullptr) {
    handover.emplace(*options.sink, blocks.blocks(), block, outcomes, [&blocks] { blocks.halt(); });
  }
  std::vector<Tally> tallies(result.threads);
  ProgressReports reports(options, planned.count(), trials_in(known), tallies, start, blocks);
  try {
    work(study, planned, options, blocks, outcomes, {prefix ? &*prefix : nullptr, handover ? &*handover : nullptr},
         tallies);
  } catch (const RunGivenUp&) {
    if (handover) handover->finish();
    throw;
  }
  result.wall_s = earlier.wall_s + seconds_since(start);
  if (handover) handover->finish();
  reports.finish();
  showing.end();
  if (finished_of(tallies) != blocks.begun())
    throw std::logic_error("a runner returned before its trials were finished");
  result.trials = gathered(std::move(outcomes), blocks.first_left(), known);
  return blocks.first_left();
}

/// Of the trials beyond the look that stopped the study, some have run, which ones is a matter of timing: drops them.
/// @param finished  trials from the first on
void cut_where_due(const Study& study, std::uint64_t finished, StudyResult& result) {
  const std::uint64_t due = trials_due(study, result.trials);
  result.complete = finished >= due;
  if (!result.complete) return;
  result.trials.index.resize(due);
  result.trials.outcomes.resize(due);
}

/// What a run of a study that does not keep all rows stands on.
SketchedRunMeans sketched_run_means(const Study& study, const Plan& plan, unsigned threads, InstructionSet simd) {
  SketchedRunMeans means;
  means.run_piece = [&study, &plan, threads, simd](TrialRange piece, const RunOptions& options, TrialTable room) {
    StudyResult result;
    result.threads = threads;
    result.simd = simd;
    run_trials(study, {plan, piece}, options, {std::move(room)}, std::nullopt, result);
    return result;
  };
  means.for_each = for_each_on(threads);
  return means;
}

/// A result to be filled in by as many workers as were asked for, but no more than there are blocks.
StudyResult begun(const Study& study, const RunOptions& options, std::uint64_t trials) {
  const std::uint64_t asked = options.threads == 0 ? default_threads() : options.threads;
  const std::uint64_t blocks = (trials + block_size(study) - 1) / block_size(study);
  StudyResult result;
  result.threads = static_cast<unsigned>(std::clamp<std::uint64_t>(blocks, 1, asked));
  if (study.integrator.method == IntegratorChoice::Method::lockstep) result.simd = options.simd;
  return result;
}

/// TBB keeps to the cores unless allowed more; the caller may ask for more. Of several such controls TBB heeds the
/// least, so that of runs that share turns is theirs alone. Nothing is asked of TBB where the cores are enough: it
/// reads the set of its controls without a lock when an arena begins, so that runs side by side should not change it.
class AllowedWorkers {
 public:
  AllowedWorkers(const RunOptions& options, unsigned workers) {
    if (options.turns != nullptr || workers <= default_threads()) return;
    control_.emplace(tbb::global_control::max_allowed_parallelism, workers);
  }

 private:
  std::optional<tbb::global_control> control_;
};

}  // namespace

std::uint64_t portion_size(const Study& study) {
  return block_size(study) * (study.store == Store::all ? 1 : Plan(study).cells());
}

std::uint64_t block_size(const Study& study) {
  return study.integrator.method == IntegratorChoice::Method::cvode ? 16 : 128;
}

unsigned default_threads() {
  return static_cast<unsigned>(tbb::info::default_concurrency());
}

struct SharedWorkers::Control {
  tbb::global_control allowed;
};

SharedWorkers::SharedWorkers(unsigned workers)
    : control_(new Control{{tbb::global_control::max_allowed_parallelism, std::max(workers, 1U)}}) {}

SharedWorkers::~SharedWorkers() = default;

StudyResult run_study(const Study& study, const RunOptions& options, FinishedTrials earlier) {
  const Plan plan(study);
  StudyResult result = begun(study, options, plan.trials());
  const AllowedWorkers allow(options, result.threads);
  const TrialRange every_trial{0, plan.trials()};
  const SketchedRunMeans means = sketched_run_means(study, plan, result.threads, options.simd);
  if (study.store != Store::all) {
    result.complete = run_sketched(study, plan, every_trial, options, std::move(earlier), means, result);
  } else {
    std::optional<PrecisionWatch> watch;
    if (study.stop) watch.emplace(watch_of(study));
    const PlannedTrials planned{plan, every_trial};
    cut_where_due(study, run_trials(study, planned, options, std::move(earlier), std::move(watch), result), result);
  }
  const std::vector<std::uint64_t> to_audit = study.store == Store::all
                                                  ? trials_to_audit(study, result.trials)
                                                  : complete_rows(study, plan, options, means.for_each, result);
  // Of a few lockstep trials, which fill one block, the audit still has work for every thread.
  const unsigned cores = default_threads();
  const unsigned asked = options.threads == 0 ? cores : options.threads;
  const ForEach wide = for_each_on(std::min(asked, std::max(result.threads, cores)));
  const bool shows = result.complete && study.store == Store::all;
  const Showing showing(shows ? options.sink : nullptr, result.trials.outcomes);
  result.trajectories = retained_trajectories(study, plan, result.trials, options, wide);
  result.audit = audit_of(study, plan, to_audit, options, wide);
  return result;
}

StudyResult run_range(const Study& study, TrialRange range, const RunOptions& options, FinishedTrials earlier) {
  const Plan plan(study);
  const std::uint64_t unit = study.store == Store::all ? block_size(study) : plan.cells();
  if (range.begin > range.end || range.end > plan.trials() || range.begin % unit != 0) {
    throw std::invalid_argument("run_range: the range is not one of whole blocks of the study");
  }
  const PlannedTrials planned{plan, range};
  StudyResult result = begun(study, options, planned.count());
  const AllowedWorkers allow(options, result.threads);
  if (study.store != Store::all) {
    Study unstopped = study;
    unstopped.stop.reset();
    run_sketched(unstopped, plan, range, options, std::move(earlier),
                 sketched_run_means(study, plan, result.threads, options.simd), result);
    result.audit.tolerance = auditor_of(study.integrator).tolerance;
    return result;
  }
  std::optional<RangeSink> sink;
  if (options.sink != nullptr) sink.emplace(*options.sink, range.begin);
  RunOptions of_range = options;
  of_range.sink = sink ? &*sink : nullptr;
  run_trials(study, planned, of_range, counted_from(range, std::move(earlier)), std::nullopt, result);
  for (std::uint64_t& index : result.trials.index) index += range.begin;
  result.audit.tolerance = auditor_of(study.integrator).tolerance;
  return result;
}

}  // namespace steerstat
