#include "distributed/lead.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/elapsed.hpp"
#include "core/errors.hpp"
#include "distributed/job.hpp"
#include "distributed/pauses.hpp"
#include "distributed/prefix_watch.hpp"
#include "distributed/range_dealer.hpp"
#include "store/sketched_part.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

using Clock = std::chrono::steady_clock;

/// Finished trials in a row.
struct Piece {
  std::uint64_t begin;
  std::vector<TrialOutcome> outcomes;
};

FinishedTrials in_order(std::vector<Piece> pieces) {
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.begin < b.begin; });
  FinishedTrials all;
  for (Piece& piece : pieces) {
    for (std::uint64_t i = 0; i < piece.outcomes.size(); ++i) all.trials.index.push_back(piece.begin + i);
    all.trials.outcomes.insert(all.trials.outcomes.end(), piece.outcomes.begin(), piece.outcomes.end());
    piece.outcomes = {};
  }
  return all;
}

class Leader {
 public:
  Leader(Ranks& ranks, const Study& study, const RunOptions& options, const FinishedTrials& earlier,
         StudyDirectory* directory, const Sharing& sharing)
      : ranks_(ranks),
        study_(study),
        options_(options),
        directory_(directory),
        writes_(directory != nullptr && sharing.gather),
        keeps_pieces_(directory == nullptr || sharing.gather || study.store != Store::all),
        trials_(Plan(study).trials()),
        dealer_(earlier.ranges(), trials_, unit_of(study), static_cast<unsigned>(ranks.count()), size_of(sharing)),
        watch_(study, earlier.trials),
        workers_(static_cast<std::size_t>(ranks.count())) {
    progress_.requested = trials_;
    progress_.earlier = trials_ - dealer_.left();
    job_.spec = canonical_spec(study);
    if (directory != nullptr && !sharing.gather) {
      job_.directory = std::filesystem::absolute(directory->path()).string();
    }
    job_.send_outcomes = sends_outcomes();
  }

  /// Leads until no rank works any more.
  void lead() {
    for (int rank = 0; rank < ranks_.count(); ++rank) {
      ranks_.send_to_worker(rank, MessageKind::job, job_.message().bytes());
    }
    working_ = ranks_.count();
    Pauses pauses;
    while (working_ > 0) {
      report();
      if (options_.stop.stop_requested() || watch_.stopped()) dealer_.halt();
      if (std::optional<Message> message = ranks_.next_for_leader()) {
        take(*message);
        pauses.begin_anew();
      } else {
        pauses.pause();
      }
    }
    if (callback_failure_) std::rethrow_exception(callback_failure_);
    if (!failure_.empty()) throw RunFailure(failure_);
  }

  /// What ranks have sent, where it is kept in memory.
  [[nodiscard]] FinishedTrials take_finished() {
    return study_.store == Store::all ? in_order(std::move(pieces_)) : std::move(sketched_);
  }
  [[nodiscard]] bool keeps_pieces() const { return keeps_pieces_; }
  [[nodiscard]] double seconds() const { return seconds_since(start_); }
  [[nodiscard]] unsigned threads() const { return threads_; }
  [[nodiscard]] InstructionSet simd() const { return simd_; }

 private:
  struct Worker {
    unsigned threads{1};
    double rate{0.0};            // [1/s] in its last range
    std::uint64_t under_way{0};  // trials finished of its range
    TrialRange range{0, 0};
  };

  void take(const Message& message) {
    Worker& worker = workers_[static_cast<std::size_t>(message.from)];
    MessageReader reader(message.bytes);
    switch (message.kind) {
      case MessageKind::ready: {
        const auto readiness = reader.get<Readiness>();
        worker.threads = readiness.threads;
        threads_ += readiness.threads;
        simd_ = std::max(simd_, readiness.simd);  // best first
        return deal(message.from);
      }
      case MessageKind::progress:
        worker.under_way = reader.get<std::uint64_t>();
        return;
      case MessageKind::finished: {
        const auto finished = reader.get<FinishedRange>();
        note(worker, finished);
        if (study_.store == Store::all) {
          take(finished, reader.get_rest<TrialOutcome>());
        } else {
          take_sketched(reader.get_rest<std::byte>());
        }
        return deal(message.from);
      }
      default:
        return fail(message.from, reader.get_text());
    }
  }

  void note(Worker& worker, const FinishedRange& finished) {
    worker.under_way = 0;
    completed_ += finished.count;
    if (finished.wall_s > 0.0) worker.rate = static_cast<double>(finished.count) / finished.wall_s;
    if (finished.count < worker.range.end - worker.range.begin) dealer_.halt();  // it was interrupted
  }

  void take(const FinishedRange& finished, std::vector<TrialOutcome> outcomes) {
    if (outcomes.empty()) return;
    if (writes_) attempt([&] { directory_->keep(finished.begin, outcomes, finished.wall_s); });
    if (keeps_pieces_) pieces_.push_back({finished.begin, outcomes});
    watch_.add(finished.begin, std::move(outcomes));
  }

  void take_sketched(std::span<const std::byte> part) {
    if (part.empty()) return;
    attempt([&] {
      FinishedTrials piece = sketched_part_of(part, origin_of(study_), study_);
      if (writes_) directory_->keep(piece);
      sketched_ = joined(std::move(sketched_), std::move(piece));
    });
  }

  template <class Action>
  void attempt(const Action& action) {
    try {
      action();
    } catch (const RunFailure& failure) {
      note(failure.what());
    }
  }

  /// Gives a rank its next range, or tells it that there is none.
  void deal(int rank) {
    Worker& worker = workers_[static_cast<std::size_t>(rank)];
    if (options_.stop.stop_requested() || watch_.stopped()) dealer_.halt();
    const std::optional<TrialRange> range = dealer_.deal(worker.threads, worker.rate);
    if (!range) return retire(rank);
    worker.range = *range;
    ranks_.send_to_worker(rank, MessageKind::range, MessageWriter{}.put(*range).bytes());
  }

  void retire(int rank) {
    ranks_.send_to_worker(rank, MessageKind::over, {});
    --working_;
  }

  void fail(int rank, const std::string& what) {
    workers_[static_cast<std::size_t>(rank)].under_way = 0;
    note(what);
    retire(rank);
  }

  /// Notes what failed first, and lets the ranks come to an end.
  void note(const std::string& failure) {
    if (failure_.empty()) failure_ = failure;
    dealer_.halt();
  }

  void report() {
    constexpr std::chrono::milliseconds interval{200};
    if (!options_.on_progress || callback_failure_ || Clock::now() - last_report_ < interval) return;
    last_report_ = Clock::now();
    progress_.elapsed = seconds();
    progress_.completed = progress_.earlier + completed_;
    for (const Worker& worker : workers_) progress_.completed += worker.under_way;
    try {
      options_.on_progress(progress_);
    } catch (...) {
      callback_failure_ = std::current_exception();
      dealer_.halt();
    }
  }

  [[nodiscard]] bool sends_outcomes() const { return keeps_pieces_ || study_.stop.has_value(); }

  /// Rows are a message's, or at least in a rank's memory; a sketch is as large of any number of trials.
  [[nodiscard]] RangeSize size_of(const Sharing& sharing) const {
    RangeSize size{sharing.seconds_a_range.value_or(usual_seconds_a_range(ranks_.count())), std::uint64_t{1} << 18};
    if (!sends_outcomes()) size.most_trials = std::uint64_t{1} << 20;
    if (study_.store != Store::all) size.most_trials = std::uint64_t{1} << 40;
    return size;
  }

  /// A sketch can take any draws, and no trial twice; rows any blocks, where a trial may run again.
  static std::uint64_t unit_of(const Study& study) {
    return study.store == Store::all ? block_size(study) : Plan(study).cells();
  }

  Ranks& ranks_;
  const Study& study_;
  const RunOptions& options_;
  StudyDirectory* const directory_;
  const bool writes_;        // outcomes into the directory
  const bool keeps_pieces_;  // outcomes in memory; of sketches always, so that none has to be read again at the end
  const std::uint64_t trials_;
  RangeDealer dealer_;
  PrefixWatch watch_;
  Job job_;
  std::vector<Worker> workers_;  // by rank
  int working_{0};               // ranks that were not told that it is over
  std::vector<Piece> pieces_;
  FinishedTrials sketched_;  // instead, of a study that does not keep all rows
  std::uint64_t completed_{0};
  std::string failure_;
  std::exception_ptr callback_failure_{};
  Progress progress_;
  unsigned threads_{0};
  InstructionSet simd_{InstructionSet::avx512};
  const Clock::time_point start_{Clock::now()};
  Clock::time_point last_report_{};
};

}  // namespace

double usual_seconds_a_range(int ranks) {
  return std::max(2.0, ranks / 50.0);
}

RankedRun run_on_ranks(Ranks& ranks, const Study& study, const RunOptions& options, FinishedTrials earlier,
                       StudyDirectory* directory, const Sharing& sharing) {
  Leader leader(ranks, study, options, earlier, directory, sharing);
  {
    // Ends by itself: lead() returns or throws once every rank was told that it is over, this one too.
    const std::jthread worker(
        [&ranks, work = WorkOptions{options.threads, options.simd, options.stop}] { work_on_next_job(ranks, work); });
    leader.lead();
  }
  RankedRun run;
  run.threads = leader.threads();
  if (study.integrator.method == IntegratorChoice::Method::lockstep) run.simd = leader.simd();
  const double wall_s = earlier.wall_s + leader.seconds();
  FinishedTrials now;
  if (leader.keeps_pieces()) {
    now = leader.take_finished();
  } else {
    Recovery recovery = directory->recover();
    now = std::move(recovery.finished);
    run.set_aside = std::move(recovery.set_aside);
  }
  run.finished = joined(std::move(earlier), std::move(now));
  run.finished.wall_s = wall_s;
  return run;
}

StudyResult completed(const Study& study, const RunOptions& options, RankedRun ranked) {
  StudyResult result = run_study(study, options, std::move(ranked.finished));
  result.threads = ranked.threads;
  if (ranked.simd) result.simd = ranked.simd;
  return result;
}

void end_ranks(Ranks& ranks, int exit_code) {
  for (int rank = 1; rank < ranks.count(); ++rank) {
    ranks.send_to_worker(rank, MessageKind::end, MessageWriter{}.put(std::int32_t{exit_code}).bytes());
  }
}

}  // namespace steerstat
