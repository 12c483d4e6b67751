#include "store/study_directory.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "store/sketched_part.hpp"
#include "store/study_files.hpp"
#include "store/whole_file.hpp"
#include "study/plan.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

namespace fs = std::filesystem;

constexpr const char* damaged_prefix = "damaged-";

/// A directory that is new is on the disk with its name before anything is kept in it.
void make_directory(const fs::path& path) {
  std::error_code error;
  const bool made = fs::create_directory(path, error);
  if (error) fail_at("make the directory", path, error);
  if (made) sync_directory(path.has_parent_path() ? path.parent_path() : ".");
}

}  // namespace

StudyDirectory::StudyDirectory(fs::path path) : path_(std::move(path)) {
  make_directory(path_);
  lock_.emplace(path_);
  for (const fs::path& file : files_in(path_, {temporary_prefix})) {
    if (!is_own_temporary(file)) remove_file(file);  // others of this process may be at work on what is no trial
  }
}

bool StudyDirectory::has_shards() const {
  return !files_in(path_, {shard_prefix, damaged_prefix}).empty();
}

std::optional<StoredStudy> StudyDirectory::begun() const {
  const fs::path file = path_ / study_file;
  std::error_code error;
  if (!fs::exists(file, error) && !error) return std::nullopt;
  return read_result(file);
}

/// Whether the directory's study is this share of this one, of this version of the engine.
bool StudyDirectory::holds(const Study& study, std::optional<StudyShare> share) const {
  try {
    const std::optional<StoredStudy> before = begun();
    return before && before->engine_version == engine_version() && before->result.share == share &&
           canonical_spec(before->study) == canonical_spec(study);
  } catch (const RunFailure&) {
    return false;
  }
}

SetAside StudyDirectory::set_study_aside(const std::string& reason) {
  study_.reset();
  return set_aside(path_ / study_file, reason);
}

void StudyDirectory::begin(const Study& study, std::optional<StudyShare> share) {
  study_ = study;
  origin_ = origin_of(study);
  if (holds(study, share)) return;
  StudyResult nothing;
  nothing.share = share;
  write_result(path_ / study_file, study, nothing);
}

FinishedTrials StudyDirectory::read_part(const fs::path& file) const {
  if (study_->store != Store::all) return read_sketched_part(file, origin_, *study_);
  return finished_trials(read_shard(file, origin_, Plan(*study_).trials()));
}

Recovery StudyDirectory::recover() {
  // A rule sees trials in order, and no sketch tells what it would have seen of trials before a gap.
  const bool in_order = study_.value().store != Store::all && study_->stop;
  Recovery recovery;
  for (const fs::path& file : files_in(path_, {shard_prefix})) {
    try {
      FinishedTrials part = read_part(file);
      const bool follows =
          recovery.finished.count() == 0 || recovery.finished.ranges().back().end == part.ranges().front().begin;
      if (in_order && !follows) continue;
      recovery.finished = joined(std::move(recovery.finished), std::move(part));
    } catch (const RunFailure& damage) {
      recovery.set_aside.push_back(set_aside(file, damage.what()));
    }
  }
  return recovery;
}

SetAside StudyDirectory::set_aside(const fs::path& file, const std::string& reason) const {
  fs::path name;
  unsigned count = 0;
  do {
    const std::string number = ++count == 1 ? "" : fmt::format("{}-", count);
    name = path_ / (damaged_prefix + number + file.filename().string());
  } while (fs::exists(name));
  std::error_code error;
  fs::rename(file, name, error);
  if (error) fail_at("rename", file, error);
  return {name, reason};
}

void StudyDirectory::keep(std::uint64_t first, std::span<const TrialOutcome> outcomes, double wall_s) {
  write_shard(path_, origin_, first, outcomes, wall_s);
}

void StudyDirectory::keep(const FinishedTrials& piece) {
  write_sketched_part(path_, origin_, piece);
}

void StudyDirectory::consolidate(const fs::path& path, const StudyResult& result) {
  write_result(path, study_.value(), result, path_);
  remove_files({shard_prefix, damaged_prefix});
}

void StudyDirectory::remove() {
  // In this order: as long as there are trials, there is the study that they are of.
  remove_files({shard_prefix, damaged_prefix, temporary_prefix, study_file, DirectoryLock::file_name});
  lock_.reset();
  std::error_code error;
  fs::remove(path_, error);
  if (error && error != std::errc::directory_not_empty) fail_at("delete", path_, error);
}

void StudyDirectory::remove_files(std::initializer_list<const char*> prefixes) const {
  for (const char* const prefix : prefixes) {
    for (const fs::path& file : files_in(path_, {prefix})) remove_file(file);
  }
}

void ShardSink::take(std::uint64_t begin, std::span<const TrialOutcome> outcomes) {
  const Clock::time_point now = Clock::now();
  directory_.keep(begin, outcomes, std::chrono::duration<double>(now - last_).count());
  last_ = now;
}

void ShardSink::take_sketched(const FinishedTrials& piece) {
  directory_.keep(piece);
}

}  // namespace steerstat
