#include "service/data_directory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "store/whole_file.hpp"
#include "study/continuation.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

namespace fs = std::filesystem;
using Tell = std::function<void(const std::string&)>;

[[noreturn]] void fail(const char* verb, const fs::path& path, const std::error_code& error) {
  throw RunFailure(fmt::format("cannot {} {} ({})", verb, path.string(), error.message()));
}

/// Its name is on the disk before anything is kept in it.
void make(const fs::path& path) {
  std::error_code error;
  const bool is_new = fs::create_directory(path, error);
  if (error) fail("make the directory", path, error);
  if (is_new) sync_directory(path.has_parent_path() ? path.parent_path() : ".");
}

/// What is left when the record cannot be read: when it was made is known, how it ended follows from its files.
StudyRecord record_from_files(const StudyHome& home, const StoredStudy& stored) {
  StudyRecord record;
  record.created = stored.created;
  record.revision = next_revision(0);
  std::error_code ignored;
  if (fs::exists(home.result(), ignored)) {
    const KeptStudy kept = home.read(stored.study, {stored.engine_version, trials_sha256(stored.study)});
    if (kept.result.complete) {
      record.status = StudyStatus::succeeded;
      record.completed = kept.result.trials.index.size();
      record.finished = stored.created;
    }
  }
  return record;
}

StudyRecord record_of(const StudyHome& home, const StoredStudy& stored, const Tell& tell) {
  StudyRecord record;
  try {
    record = read_record(home.record());
  } catch (const RunFailure& damage) {
    tell(fmt::format("{}; made it again from the study's other files", damage.what()));
    record = record_from_files(home, stored);
    write_record(home.record(), record);
  }
  if (is_over(record.status)) return record;
  record.revision = next_revision(record.revision);
  record.completed = std::max(record.completed, home.trials_in_shards());  // exactly, once it runs
  if (stored.engine_version == engine_version()) return record;
  record.status = StudyStatus::failed;
  record.failure = fmt::format(
      "it was begun by engine {} and this is {}, whose trials may differ in their bits; submit it again to begin anew",
      stored.engine_version, engine_version());
  record.finished = utc_now();
  return record;
}

/// @throws RunFailure where it is damaged
std::shared_ptr<StudyEntry> entry_of(const StudyHome& home, const Tell& tell) {
  home.clear_temporaries();
  const std::string id = home.path().filename().string();
  StoredStudy stored = home.study();
  if (stored.engine_version == engine_version() && study_id(stored.study) != id) {
    throw RunFailure(fmt::format("{} holds another study, {}", home.path().string(), study_id(stored.study)));
  }
  StudyRecord record = record_of(home, stored, tell);
  ShardOrigin origin{stored.engine_version, trials_sha256(stored.study)};
  return std::make_shared<StudyEntry>(id, std::make_shared<const Study>(std::move(stored.study)), home,
                                      std::move(origin), std::move(record));
}

std::vector<fs::path> directories_in(const fs::path& path) {
  std::error_code error;
  std::vector<fs::path> found;
  fs::directory_iterator entry(path, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_directory(ignored)) found.push_back(entry->path());
  }
  if (error) fail("list", path, error);
  return found;
}

}  // namespace

DataDirectory::DataDirectory(const fs::path& path) : studies_(path / "studies") {
  make(path);
  lock_ = std::make_unique<DirectoryLock>(path);
  make(studies_);
}

std::vector<std::shared_ptr<StudyEntry>> DataDirectory::recover(const Tell& tell) const {
  std::vector<std::shared_ptr<StudyEntry>> entries;
  for (const fs::path& path : directories_in(studies_)) {
    const std::string name = path.filename().string();
    const StudyHome home(path);
    if (name.starts_with(StudyHome::damaged_prefix)) continue;
    try {
      if (name.starts_with(StudyHome::removed_prefix) || !home.holds_study()) {
        fs::remove_all(path);  // nobody was told of it, or somebody removed it
      } else {
        entries.push_back(entry_of(home, tell));
      }
    } catch (const std::exception& damage) {
      try {
        tell(fmt::format("{}; renamed its directory to {}", damage.what(), home.set_aside().string()));
      } catch (const std::exception& problem) {
        tell(fmt::format("{}; {}; passed it over", damage.what(), problem.what()));
      }
    }
  }
  return entries;
}

}  // namespace steerstat
