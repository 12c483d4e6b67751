#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <exception>
#include <optional>
#include <utility>

#include "core/errors.hpp"
#include "distributed/job.hpp"
#include "distributed/pauses.hpp"
#include "store/shard.hpp"
#include "store/sketched_part.hpp"
#include "study/run.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

using Clock = std::chrono::steady_clock;

Message wait_for_message(Ranks& ranks) {
  Pauses pauses;
  while (true) {
    if (std::optional<Message> message = ranks.next_for_worker()) return std::move(*message);
    pauses.pause();
  }
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "an unknown machine";
}

/// Writes the rows that a rank finishes into the study's directory, which the leader holds the lock of.
class SharedDirectorySink final : public OutcomeSink {
 public:
  SharedDirectorySink(std::filesystem::path directory, ShardOrigin origin)
      : directory_(std::move(directory)), origin_(std::move(origin)) {}

  void take(std::uint64_t begin, std::span<const TrialOutcome> outcomes) override {
    const Clock::time_point now = Clock::now();
    write_shard(directory_, origin_, begin, outcomes, std::chrono::duration<double>(now - last_).count());
    last_ = now;
  }

 private:
  const std::filesystem::path directory_;
  const ShardOrigin origin_;
  Clock::time_point last_{Clock::now()};
};

class Worker {
 public:
  Worker(Ranks& ranks, const WorkOptions& options, const Job& job)
      : ranks_(ranks), job_(job), study_(decode_study(job.spec, {})), origin_(origin_of(study_)) {
    run_options_.threads = options.threads;
    run_options_.simd = options.simd;
    run_options_.stop = options.stop;
    run_options_.on_progress = [this](const Progress& progress) { tell_progress(progress); };
    if (!job_.directory.empty()) {
      require_shared(job_.directory);
      // A sketch is as large of few trials as of many: one of the whole range is written, at its end.
      if (study_.store == Store::all) run_options_.sink = &sink_.emplace(job_.directory, origin_);
    }
  }

  void work_until_over() {
    const unsigned threads = run_options_.threads == 0 ? default_threads() : run_options_.threads;
    ranks_.send_to_leader(MessageKind::ready, MessageWriter{}.put(Readiness{threads, run_options_.simd}).bytes());
    while (true) {
      const Message message = wait_for_message(ranks_);
      if (message.kind != MessageKind::range) return;
      run(MessageReader(message.bytes).get<TrialRange>());
    }
  }

 private:
  void require_shared(const std::filesystem::path& directory) const {
    std::error_code error;
    if (std::filesystem::exists(directory / "study.h5", error)) return;
    throw RunFailure(
        fmt::format("rank {} on {} does not see the study in {}; write to a file system that all ranks "
                    "share, or add --gather",
                    ranks_.rank(), host_name(), directory.string()));
  }

  void run(TrialRange range) {
    last_progress_ = Clock::now();
    StudyResult result = run_range(study_, range, run_options_);
    const std::uint64_t finished = result.finished();
    MessageWriter message;
    message.put(FinishedRange{range.begin, finished, result.wall_s});
    if (result.sketch && finished > 0) {
      keep_sketched({std::move(result.trials), result.wall_s, std::move(result.sketch)}, message);
    } else if (job_.send_outcomes) {
      message.put_all(std::span(result.trials.outcomes));
    }
    ranks_.send_to_leader(MessageKind::finished, message.bytes());
  }

  void keep_sketched(const FinishedTrials& part, MessageWriter& message) const {
    if (!job_.directory.empty()) write_sketched_part(job_.directory, origin_, part);
    if (!job_.send_outcomes) return;
    const std::vector<std::byte> bytes = sketched_part_bytes(origin_, part);
    message.put_all(std::span(bytes));
  }

  void tell_progress(const Progress& progress) {
    constexpr std::chrono::milliseconds interval{500};
    if (Clock::now() - last_progress_ < interval) return;
    last_progress_ = Clock::now();
    ranks_.send_to_leader(MessageKind::progress, MessageWriter{}.put(progress.completed).bytes());
  }

  Ranks& ranks_;
  const Job job_;
  const Study study_;
  const ShardOrigin origin_;
  std::optional<SharedDirectorySink> sink_;
  RunOptions run_options_;
  Clock::time_point last_progress_;
};

/// After a failure: nothing but the word that it is over is of interest.
void wait_until_over(Ranks& ranks) {
  while (wait_for_message(ranks).kind == MessageKind::range) {
  }
}

void work_on(Ranks& ranks, const WorkOptions& options, const Job& job) {
  std::string failure;
  try {
    Worker(ranks, options, job).work_until_over();
    return;
  } catch (const RunFailure& problem) {
    failure = problem.what();
  } catch (const std::bad_alloc&) {
    failure = fmt::format("rank {} on {} is out of memory", ranks.rank(), host_name());
  } catch (const std::exception& bug) {
    failure = fmt::format("a bug ended the work of rank {} ({}); please report it with the command and the spec",
                          ranks.rank(), bug.what());
  }
  ranks.send_to_leader(MessageKind::failed, MessageWriter{}.put(failure).bytes());
  wait_until_over(ranks);
}

}  // namespace

void work_on_next_job(Ranks& ranks, const WorkOptions& options) {
  work_on(ranks, options, Job::read(wait_for_message(ranks).bytes));
}

int work(Ranks& ranks, const WorkOptions& options) {
  while (true) {
    const Message message = wait_for_message(ranks);
    if (message.kind == MessageKind::end) return MessageReader(message.bytes).get<std::int32_t>();
    if (message.kind == MessageKind::job) work_on(ranks, options, Job::read(message.bytes));
  }
}

}  // namespace steerstat
