#include "durable_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "distributed/lead.hpp"
#include "output.hpp"
#include "report/readable.hpp"
#include "study/continuation.hpp"
#include "study/plan.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

namespace fs = std::filesystem;

/// Whether a result goes to a device or a pipe, which nothing can stand beside.
bool is_stream(const fs::path& result) {
  const fs::file_status status = fs::status(result);
  return fs::exists(status) && !fs::is_regular_file(status);
}

/// Beside the file that a link names, where the result goes.
fs::path parts_of(const fs::path& result) {
  return (fs::exists(result) ? fs::canonical(result) : result).string() + ".parts";
}

/// "the whole study" or "shard 3/10 of it".
std::string part_text(const std::optional<StudyShare>& share) {
  return share ? fmt::format("shard {} of it", share_text(*share)) : "the whole study";
}

void tell_of(const std::vector<SetAside>& set_aside) {
  for (const SetAside& aside : set_aside) {
    tell(fmt::format("{}; renamed it to {}, its trials run again", aside.reason, aside.file.string()));
  }
}

/// Runs `action`; where it fails, the message goes on to say that nothing is lost.
template <class Action>
auto saying_what_is_kept(const std::optional<StudyDirectory>& directory, const Action& action) {
  try {
    return action();
  } catch (const RunFailure& failure) {
    if (!directory || !directory->has_shards()) throw;
    throw RunFailure(fmt::format("{}; the finished trials are kept in {}, to be continued with --resume",
                                 failure.what(), directory->path().string()));
  }
}

}  // namespace

DurableRun::DurableRun(const fs::path& result, const Study& study, std::optional<StudyShare> share, bool resume)
    : path_(result), study_(study), share_(share), due_(Plan(study).trials()) {
  if (share_) {
    const TrialRange range = trials_of(study, *share_);
    due_ = range.end - range.begin;
  }
  if (is_stream(result)) {
    if (resume) throw BadUsage(fmt::format("--resume: {} is not a file; name one with -o", result.string()));
    return;
  }
  parts_ = parts_of(result);
  if (resume) {
    this->resume();
  } else {
    begin_anew();
  }
}

void DurableRun::begin_anew() {
  directory_.emplace(parts_);
  if (directory_->has_shards()) {
    throw BadUsage(
        fmt::format("{} holds the finished trials of an interrupted run; add --resume to continue it, or "
                    "delete the directory to begin anew",
                    parts_.string()));
  }
  directory_->begin(study_, share_);
}

void DurableRun::resume() {
  const bool interrupted = fs::exists(parts_);
  std::optional<StoredStudy> earlier = earlier_result(interrupted);
  directory_.emplace(parts_);
  if (earlier && has_nothing_left(*earlier)) {
    tell(fmt::format("{} is complete; nothing is left to run", path_.string()));
    directory_->remove();
    whole_ = std::move(earlier->result);
    return;
  }
  FinishedTrials of_parts = recover();
  if (earlier) {
    finished_ = {std::move(earlier->result.trials), earlier->result.wall_s, std::move(earlier->result.sketch)};
  }
  finished_ = joined(std::move(finished_), std::move(of_parts));
  tell(fmt::format("resuming after {} of {} trials", readable_count(finished_.count()), readable_count(due_)));
}

/// Why `stored`, found at `place`, cannot be continued; "" where it can.
std::string DurableRun::objection(const StoredStudy& stored, const fs::path& place) const {
  if (stored.engine_version != engine_version()) {
    return fmt::format("{} is of engine version {} and this is {}, whose trials may differ in their bits",
                       place.string(), stored.engine_version, engine_version());
  }
  if (!stored.has_metrics) return fmt::format("{} is of a program that measured no metrics", place.string());
  if (continues(study_, stored.study)) {
    if (stored.result.share != share_) {
      return fmt::format("{} is of {} and this run is of {}", place.string(), part_text(stored.result.share),
                         part_text(share_));
    }
    if (!share_ || Plan(stored.study).trials() == Plan(study_).trials()) return "";
    return fmt::format("{} is a shard of {} trials and the spec asks for {} (more trials divide anew)", place.string(),
                       readable_count(Plan(stored.study).trials()), readable_count(Plan(study_).trials()));
  }
  if (continues(stored.study, study_)) {
    return fmt::format("{} is of {} trials and the spec asks for {} (a study can be extended, not cut)", place.string(),
                       readable_count(Plan(stored.study).trials()), readable_count(Plan(study_).trials()));
  }
  return fmt::format("{} is of another study, {} with id {} (the spec given is {} with id {})", place.string(),
                     printable(stored.study.name), study_id(stored.study), printable(study_.name), study_id(study_));
}

void DurableRun::require_continuation(const StoredStudy& stored, const fs::path& place) const {
  const std::string problem = objection(stored, place);
  if (problem.empty()) return;
  throw BadUsage(
      fmt::format("--resume: {}; name another output with -o, or delete {} to begin anew", problem, place.string()));
}

/// @param stored  to be continued
bool DurableRun::has_nothing_left(const StoredStudy& stored) const {
  const std::uint64_t there = stored.result.finished();
  if (share_) return there == due_;
  return stored.result.complete && stored.result.audit.trials.size() == std::min(study_.audited_trials, there) &&
         spec_sha256(stored.study) == spec_sha256(study_);
}

/// What stands at the result's place, if it is of this study.
/// @param interrupted  whether a run that would have replaced it was interrupted, so that it may be of any other
std::optional<StoredStudy> DurableRun::earlier_result(bool interrupted) const {
  if (!fs::exists(path_)) return std::nullopt;
  try {
    StoredStudy stored = read_result(path_);
    if (!interrupted) require_continuation(stored, path_);
    if (objection(stored, path_).empty()) return stored;
  } catch (const RunFailure& failure) {
    if (!interrupted) throw;
  }
  return std::nullopt;
}

/// The trials in the directory.
FinishedTrials DurableRun::recover() {
  std::optional<StoredStudy> begun;
  try {
    begun = directory_->begun();
  } catch (const RunFailure& failure) {
    const SetAside aside = directory_->set_study_aside(failure.what());
    tell(fmt::format("{}; renamed it to {}", aside.reason, aside.file.string()));
  }
  if (begun) require_continuation(*begun, parts_);
  directory_->begin(study_, share_);
  Recovery recovery = directory_->recover();
  tell_of(recovery.set_aside);
  return std::move(recovery.finished);
}

StudyResult DurableRun::run(RunOptions options, Ranks* ranks, const Sharing& sharing) {
  if (whole_) return *whole_;
  if (ranks != nullptr) {
    return saying_what_is_kept(directory_, [&] { return run_together(options, *ranks, sharing); });
  }
  if (!directory_) return run_now(options);
  ShardSink sink(*directory_);
  options.sink = &sink;
  return saying_what_is_kept(directory_, [&] { return run_now(options); });
}

StudyResult DurableRun::run_now(const RunOptions& options) {
  if (!share_) return run_study(study_, options, std::move(finished_));
  StudyResult result = run_range(study_, trials_of(study_, *share_), options, std::move(finished_));
  result.share = share_;
  return result;
}

StudyResult DurableRun::run_together(const RunOptions& options, Ranks& ranks, const Sharing& sharing) {
  StudyDirectory* const directory = directory_ ? &*directory_ : nullptr;
  RankedRun ranked = run_on_ranks(ranks, study_, options, std::move(finished_), directory, sharing);
  tell_of(ranked.set_aside);
  return completed(study_, options, std::move(ranked));
}

void DurableRun::keep(const StudyResult& result) {
  if (whole_) return;
  if (!directory_) return write_result(path_, study_, result);
  saying_what_is_kept(directory_, [&] {
    directory_->consolidate(path_, result);
    directory_->remove();
  });
}

}  // namespace steerstat
