#include "study/run.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "study/block_queue.hpp"
#include "study/finished_prefix.hpp"
#include "study/handover.hpp"
#include "study/sketched_run.hpp"
#include "study/trial_range.hpp"

namespace steerstat {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// One worker's count of finished trials, on a cache line of its own so that counting costs the other workers nothing.
struct alignas(64) Tally {
  std::atomic<std::uint64_t> finished{0};
};

/// What is told of every finished trial, beside its slot.
struct Listeners {
  FinishedPrefix* prefix;  ///< null where nothing but the last trial ends the run
  HandOver* handover;      ///< null where nobody takes the outcomes meanwhile
};

std::uint64_t total(const std::vector<Tally>& tallies) {
  return std::accumulate(tallies.begin(), tallies.end(), std::uint64_t{0}, [](std::uint64_t sum, const Tally& tally) {
    return sum + tally.finished.load(std::memory_order_relaxed);
  });
}

/// The trials of a plan from one on, counted from it.
struct PlannedTrials {
  const Plan& plan;
  TrialRange range;

  [[nodiscard]] std::uint64_t count() const { return range.end - range.begin; }
  [[nodiscard]] TrialParameters parameters(std::uint64_t index) const { return plan.parameters(range.begin + index); }
};

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

/// Feeds one worker's runner block after block, so that its lanes refill across blocks, and stores each outcome in the
/// slot of its index. The slots of different trials are distinct objects: no two workers write the same one.
class BlockStream final : public TrialStream {
 public:
  BlockStream(const PlannedTrials& planned, BlockQueue& blocks, std::vector<TrialOutcome>& outcomes,
              Listeners listeners, Tally& tally, Turnstile::Turn& turn)
      : planned_(planned), blocks_(blocks), outcomes_(outcomes), listeners_(listeners), tally_(tally), turn_(turn) {}

  bool next(std::uint64_t& index, TrialParameters& parameters) override {
    if (block_.begin == block_.end) {
      if (dry_) return false;
      turn_.give_way();
      const std::optional<TrialRange> claimed = blocks_.claim();
      dry_ = !claimed;
      if (dry_) return false;
      block_ = *claimed;
    }
    index = block_.begin++;
    parameters = planned_.parameters(index);
    return true;
  }

  void finished(std::uint64_t index, const TrialOutcome& outcome) override {
    outcomes_[index] = outcome;
    tally_.finished.fetch_add(1, std::memory_order_relaxed);
    if (listeners_.prefix != nullptr && listeners_.prefix->finished(index)) blocks_.halt();
    if (listeners_.handover != nullptr) listeners_.handover->finished(index);
  }

 private:
  const PlannedTrials planned_;
  BlockQueue& blocks_;
  std::vector<TrialOutcome>& outcomes_;
  const Listeners listeners_;
  Tally& tally_;
  Turnstile::Turn& turn_;
  TrialRange block_{0, 0};
  bool dry_{false};  // a runner may ask again after the end; the answer stays no
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

/// Calls the progress callback from a thread of its own, which sleeps in between, until destroyed or finish()ed.
class ProgressReports {
 public:
  /// @param earlier  trials finished before the run
  ProgressReports(const RunOptions& options, std::uint64_t requested, std::uint64_t earlier,
                  const std::vector<Tally>& tallies, Clock::time_point start, BlockQueue& blocks)
      : callback_(options.on_progress),
        requested_(requested),
        earlier_(earlier),
        tallies_(tallies),
        start_(start),
        blocks_(blocks) {
    if (callback_) thread_ = std::jthread([this](const std::stop_token& stop) { report_until(stop); });
  }

  /// Makes the last report, from the calling thread. @throws what the callback threw
  void finish() {
    if (!callback_) return;
    thread_.request_stop();
    thread_.join();
    if (failure_) std::rethrow_exception(failure_);
    report();
  }

 private:
  void report() { callback_(Progress{earlier_ + total(tallies_), requested_, seconds_since(start_), earlier_}); }

  void report_until(const std::stop_token& stop) {
    constexpr std::chrono::milliseconds interval{200};
    std::mutex mutex;
    std::condition_variable_any wake;
    std::unique_lock lock(mutex);
    try {
      while (!stop.stop_requested()) {
        report();
        wake.wait_for(lock, stop, interval, [] { return false; });
      }
    } catch (...) {
      failure_ = std::current_exception();
      blocks_.halt();
    }
  }

  const std::function<void(const Progress&)>& callback_;
  const std::uint64_t requested_;
  const std::uint64_t earlier_;
  const std::vector<Tally>& tallies_;
  const Clock::time_point start_;
  BlockQueue& blocks_;
  std::exception_ptr failure_{};
  std::jthread thread_{};  // last: it uses all of the above
};

/// The first `first` of all rows and the first `failed` that did not converge, ascending, each once.
/// @param all_rows  whether the table has the rows of all finished trials
std::vector<std::uint64_t> rows_to_retain(const Retention& retention, const TrialTable& trials, bool all_rows) {
  std::vector<std::uint64_t> rows;
  std::uint64_t failures = 0;
  for (std::uint64_t row = 0; row < trials.outcomes.size(); ++row) {
    const bool failed = trials.outcomes[row].status != Status::converged;
    const bool first = (all_rows ? row : trials.index[row]) < retention.first;
    if (first || (failed && failures < retention.failed)) rows.push_back(row);
    failures += failed ? 1 : 0;
    if (!first && failures >= retention.failed) break;
  }
  return rows;
}

std::vector<StudyResult::Retained> retained_trajectories(const Study& study, const Plan& plan, const TrialTable& trials,
                                                         Turnstile* turns) {
  const std::vector<std::uint64_t> rows = rows_to_retain(study.retention, trials, study.store == Store::all);
  std::vector<StudyResult::Retained> retained(rows.size());
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t i) {
    const Turnstile::Turn turn(turns);
    const std::uint64_t index = trials.index[rows[i]];
    retained[i] = {index, replay(plan.parameters(index), study.integrator)};
    if (!same_bits(retained[i].trajectory.outcome, trials.outcomes[rows[i]])) {
      throw std::logic_error("the replay of trial " + std::to_string(index) + " ended differently from its run");
    }
  });
  return retained;
}

/// The indices of trials to audit.
std::vector<std::uint64_t> trials_to_audit(const Study& study, const TrialTable& trials) {
  std::vector<std::uint64_t> indices = rows_to_audit(study.sampling.seed, study.audited_trials, trials.index.size());
  for (std::uint64_t& row : indices) row = trials.index[row];
  return indices;
}

/// Computes trials of the run again with the reference integrator. After a stop request no further one is begun.
Audit audit_of(const Study& study, const Plan& plan, std::span<const std::uint64_t> indices,
               const RunOptions& options) {
  const IntegratorChoice auditor = auditor_of(study.integrator);
  std::vector<std::optional<AuditedTrial>> finished(indices.size());
  const auto audit_one = [&](std::size_t i) {
    const Turnstile::Turn turn(options.turns);
    if (options.stop.stop_requested()) return;
    const std::uint64_t index = indices[i];
    finished[i] = audited(index, make_runner(auditor)->run(plan.parameters(index)));
  };
  tbb::parallel_for(std::size_t{0}, indices.size(), audit_one, tbb::simple_partitioner{});
  Audit audit{auditor.tolerance, {}};
  for (const std::optional<AuditedTrial>& trial : finished) {
    if (trial) audit.trials.push_back(*trial);
  }
  return audit;
}

PrecisionWatch watch_of(const Study& study, const Plan& plan) {
  return {*study.stop, study.sampling.trials, plan.cells()};
}

/// Shows the rule the trials that were finished before the run.
void show(FinishedPrefix& prefix, std::span<const TrialRange> known, BlockQueue& blocks) {
  bool stopped = false;
  for (const TrialRange& range : known) {
    for (std::uint64_t index = range.begin; index < range.end; ++index) stopped = prefix.finished(index);
  }
  if (stopped) blocks.halt();
}

/// Runs the workers until no block is left to begin. @throws what a worker threw
void work(const Study& study, const PlannedTrials& planned, const RunOptions& options, BlockQueue& blocks,
          std::vector<TrialOutcome>& outcomes, Listeners listeners, std::vector<Tally>& tallies) {
  const auto work_as = [&](std::size_t worker) {
    try {
      Turnstile::Turn turn(options.turns);
      BlockStream stream(planned, blocks, outcomes, listeners, tallies[worker], turn);
      const auto runner =
          options.make_runner ? options.make_runner(study.integrator) : make_runner(study.integrator, options.simd);
      runner->run(stream);
    } catch (...) {
      blocks.halt();
      throw;  // TBB hands the first to the caller
    }
  };
  tbb::task_arena arena(static_cast<int>(tallies.size()));
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, tallies.size(), work_as, tbb::simple_partitioner{}); });
}

/// Runs what was not finished earlier; until the watch has stopped, where there is one. Fills in the trials, counted as
/// they are planned, and their time.
/// @return the first trial that was not begun, before which all are finished
std::uint64_t run_trials(const Study& study, const PlannedTrials& planned, const RunOptions& options,
                         FinishedTrials earlier, std::optional<PrecisionWatch> watch, StudyResult& result) {
  const Clock::time_point start = Clock::now();
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
  work(study, planned, options, blocks, outcomes, {prefix ? &*prefix : nullptr, handover ? &*handover : nullptr},
       tallies);
  result.wall_s = earlier.wall_s + seconds_since(start);
  if (handover) handover->finish();
  reports.finish();
  showing.end();
  if (total(tallies) != blocks.begun()) throw std::logic_error("a runner returned before its trials were finished");
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
  means.run_piece = [&study, &plan, threads, simd](TrialRange piece, const RunOptions& options) {
    StudyResult result;
    result.threads = threads;
    result.simd = simd;
    run_trials(study, {plan, piece}, options, {}, std::nullopt, result);
    return result;
  };
  means.for_each = [threads](std::size_t count, const std::function<void(std::size_t)>& task) {
    tbb::task_arena arena(static_cast<int>(threads));
    arena.execute([&] { tbb::parallel_for(std::size_t{0}, count, task, tbb::simple_partitioner{}); });
  };
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

std::optional<StopReport> watched(const Study& study, const TrialTable& trials) {
  if (!study.stop) return std::nullopt;
  PrecisionWatch watch = watch_of(study, Plan(study));
  for (std::uint64_t row = 0; row < trials.index.size() && trials.index[row] == row && !watch.stopped(); ++row) {
    watch.add(trials.outcomes[row]);
  }
  return watch.report();
}

std::uint64_t trials_due(const Study& study, const TrialTable& trials) {
  const std::optional<StopReport> report = watched(study, trials);
  return report && report->reason ? report->trials : Plan(study).trials();
}

std::optional<StopReport> watched(const Study& study, const TrialSketch& sketch) {
  if (!study.stop) return std::nullopt;
  PrecisionWatch watch = watch_of(study, Plan(study));
  watch.skip_to(sketch.cells(), sketch.count());
  return watch.report();
}

std::optional<StopReport> watched(const Study& study, const StudyResult& result) {
  return result.sketch ? watched(study, *result.sketch) : watched(study, result.trials);
}

std::uint64_t trials_due(const Study& study, const StudyResult& result) {
  const std::optional<StopReport> report = watched(study, result);
  return report && report->reason ? report->trials : Plan(study).trials();
}

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
    if (study.stop) watch.emplace(watch_of(study, plan));
    const PlannedTrials planned{plan, every_trial};
    cut_where_due(study, run_trials(study, planned, options, std::move(earlier), std::move(watch), result), result);
  }
  const std::vector<std::uint64_t> to_audit = study.store == Store::all
                                                  ? trials_to_audit(study, result.trials)
                                                  : complete_rows(study, plan, options, means.for_each, result);
  // Of a few lockstep trials, which fill one block, the audit still has work for every thread.
  const unsigned cores = default_threads();
  const unsigned asked = options.threads == 0 ? cores : options.threads;
  tbb::task_arena wide_arena(static_cast<int>(std::min(asked, std::max(result.threads, cores))));
  const bool shows = result.complete && study.store == Store::all;
  const Showing showing(shows ? options.sink : nullptr, result.trials.outcomes);
  wide_arena.execute([&] {
    result.trajectories = retained_trajectories(study, plan, result.trials, options.turns);
    result.audit = audit_of(study, plan, to_audit, options);
  });
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
