#include "service/kept_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "core/errors.hpp"
#include "report/readable.hpp"
#include "report/summary.hpp"
#include "service/launched_run.hpp"
#include "service/live_outcomes.hpp"
#include "service/recent_rate.hpp"
#include "store/free_space.hpp"
#include "store/seal.hpp"
#include "store/whole_file.hpp"
#include "study/trial_range.hpp"

namespace steerstat {
namespace {

/// How a run ended, beside by a failure.
struct Ending {
  bool is_whole{false};
  std::uint64_t completed{0};
  std::optional<std::string> summary_seal{};
};

/// Whether nothing of the study is left to do: its trials and its audit.
bool is_whole(const Study& study, const StudyResult& result) {
  return result.complete &&
         result.audit.trials.size() == std::min<std::uint64_t>(study.audited_trials, result.trials.index.size());
}

RunOptions options_of(const KeptRun& run, OutcomeSink& sink) {
  RunOptions options;
  options.threads = run.threads;
  options.turns = &run.turns;
  options.sink = &sink;
  run.catalogue.look(run.entry, [&](const StudyEntry& entry) {
    options.stop = entry.run->stop.get_token();
    options.give_up = entry.run->give_up.get_token();
  });
  // Called from one thread at a time.
  options.on_progress = [&run, rate = RecentRate{},
                         counted = std::optional<std::uint64_t>{}](const Progress& progress) mutable {
    run.trials_done += progress.completed - counted.value_or(progress.earlier);
    counted = progress.completed;
    const std::optional<double> per_second = rate.add(RecentRate::Clock::now(), progress.completed);
    const bool is_news = run.catalogue.look(run.entry, [&](const StudyEntry& entry) {
      return entry.record.completed != progress.completed || entry.run->trials_per_s != per_second;
    });
    if (!is_news) return;
    run.catalogue.change(run.entry, [&](StudyEntry& entry) {
      entry.record.completed = progress.completed;
      entry.run->trials_per_s = per_second;
    });
  };
  return options;
}

/// Writes the summary. One that cannot be written now is made from the result when somebody asks for it.
std::optional<std::string> keep_summary(const KeptRun& run, const StudyResult& result) {
  try {
    const std::string json = summary_json(summarise(*run.entry.study, result));
    const auto bytes = std::as_bytes(std::span(json));
    write_whole_file(run.entry.home.summary(), {bytes});
    return seal_of(bytes);
  } catch (const RunFailure& failure) {
    run.tell(failure.what());
    return std::nullopt;
  }
}

StudyResult run_what_is_left(const KeptRun& run, StudyDirectory& directory, FinishedTrials earlier) {
  ShardSink shards(directory);
  const auto live = std::make_shared<LiveOutcomes>(shards, ranges_of(earlier.trials.index));
  run.catalogue.change(run.entry, [&](StudyEntry& entry) {
    entry.record.completed = earlier.trials.index.size();
    entry.run->earlier_wall_s = earlier.wall_s;
    entry.run->live = live;
  });
  return run_study(*run.entry.study, options_of(run, *live), std::move(earlier));
}

/// @throws RunFailure, and whatever a bug or a lack of memory throws
Ending run_to_end(const KeptRun& run) {
  const StudyEntry& entry = run.entry;
  const Study& study = *entry.study;
  require_free_space(entry.home.path(), entry.demand.disk + run.limits.disk_headroom);
  StudyDirectory directory(entry.home.path());
  directory.begin(study);
  std::optional<StudyResult> found = entry.home.whole_result(study);
  if (run.launcher && (!found || !found->complete)) {
    if (!run_launched(run, *run.launcher, directory))
      return {false, entry.home.read(study, entry.origin).result.finished(), {}};
    found = entry.home.whole_result(study);
    entry.home.forget_launched();
    entry.home.forget_earlier();
  } else if (!found || !is_whole(study, *found)) {
    found = run_what_is_left(run, directory, entry.home.recover(directory, study, run.tell));
    if (!is_whole(study, *found)) return {false, found->trials.index.size(), {}};
    const auto kept = std::make_shared<const KeptStudy>(KeptStudy{std::move(*found), entry.origin.engine_version});
    run.catalogue.change(run.entry, [&](StudyEntry& changed) { changed.run->result = kept; });
    directory.consolidate(entry.home.result(), kept->result);
    entry.home.forget_earlier();
    return {true, kept->result.trials.index.size(), keep_summary(run, kept->result)};
  }
  return {true, found->trials.index.size(), keep_summary(run, *found)};
}

/// The record of a study whose run is over.
StudyRecord record_after(const KeptRun& run, const Ending& ending, std::optional<std::string> failure) {
  return run.catalogue.look(run.entry, [&](const StudyEntry& entry) {
    StudyRecord record = entry.record;
    if (!failure) {
      record.completed = ending.completed;
    } else if (entry.run->live) {
      record.completed = entry.run->live->kept();
    }
    if (!failure && !ending.is_whole && entry.run->is_overtime) {
      failure = fmt::format(
          "it ran for {}, as long as a study may; its finished trials are kept: submit it again to go on, or with "
          "fewer "
          "trials",
          readable_duration(std::chrono::duration<double>(run.limits.wall_time).count()));
    }
    if (ending.is_whole) {
      record.status = StudyStatus::succeeded;
    } else if (entry.run->is_cancelled) {
      record.status = StudyStatus::cancelled;
      failure.reset();
    } else if (failure) {
      record.status = StudyStatus::failed;
    } else {
      return record;  // the service stops: it goes on at the next start
    }
    record.finished = utc_now();
    record.failure = failure;
    record.summary_seal = ending.summary_seal;
    record.revision = next_revision(record.revision);
    return record;
  });
}

/// Notes the ending on the disk, then for clients. @return whether it is on the disk
bool settle(const KeptRun& run, const Ending& ending, const std::optional<std::string>& failure) {
  const std::lock_guard keeping(run.entry.keeping);
  const StudyRecord record = record_after(run, ending, failure);
  bool is_kept = true;
  try {
    write_record(run.entry.home.record(), record);
  } catch (const std::exception& problem) {
    is_kept = false;
    run.tell(
        fmt::format("{}; how study {} ended ({}) is not on the disk: tried again until the service ends, at whose "
                    "next start it would go on",
                    problem.what(), run.entry.id, name_of(record.status)));
  }
  run.catalogue.change(run.entry, [&](StudyEntry& entry) {
    entry.record = record;
    entry.run.reset();
  });
  return is_kept;
}

}  // namespace

void keep_record(const Catalogue& catalogue, StudyEntry& entry) {
  const std::lock_guard keeping(entry.keeping);
  const StudyRecord record = catalogue.look(entry, [](const StudyEntry& now) {
    StudyRecord known = now.record;
    if (now.run && now.run->is_cancelled) known.status = StudyStatus::cancelled;
    return known;
  });
  write_record(entry.home.record(), record);
}

bool run_and_keep(const KeptRun& run) noexcept {
  Ending ending;
  std::optional<std::string> failure;
  try {
    ending = run_to_end(run);
  } catch (const RunGivenUp&) {
    ending.completed = run.catalogue.look(run.entry, [](const StudyEntry& entry) { return entry.run->live->kept(); });
    run.tell(
        fmt::format("study {} had trials in flight that take long: they are given up, and computed again if it "
                    "goes on",
                    run.entry.id));
  } catch (const std::bad_alloc&) {
    failure = "there is not enough memory for it; its finished trials are kept: submit it again when less runs";
  } catch (const RunFailure& problem) {
    failure = fmt::format("{}; its finished trials are kept: submit it again to go on", problem.what());
  } catch (const std::exception& bug) {
    failure = fmt::format("an internal error: {}; please report it", bug.what());
  } catch (...) {
    failure = "an internal error; please report it";
  }
  if (failure) run.tell(fmt::format("study {} has failed: {}", run.entry.id, *failure));
  return settle(run, ending, failure);
}

}  // namespace steerstat
