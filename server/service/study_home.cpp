#include "service/study_home.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "store/study_files.hpp"
#include "store/whole_file.hpp"
#include "study/continuation.hpp"
#include "study/plan.hpp"
#include "study/spec_json.hpp"
#include "study/trial_range.hpp"

namespace steerstat {
namespace {

namespace fs = std::filesystem;

constexpr const char* earlier_prefix = "earlier-";

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// A second name for a file that never changes, or a copy where the file system knows no second names. What is gone
/// meanwhile, because its study has got its result, is passed over.
void link_or_copy(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_hard_link(from, to, error);
  if (!error || error == std::errc::no_such_file_or_directory || error == std::errc::file_exists) return;
  const std::vector<std::byte> bytes = read_whole_file(from);
  write_whole_file(to, {bytes});
}

/// "trials-000000000000-000000065536.h5" has 65536; 0 for a name that is no shard's.
std::uint64_t trials_of(const std::string& shard) {
  constexpr std::size_t digits = 12;
  const auto number_at = [&](std::size_t place) {
    std::uint64_t number = 0;
    if (place + digits <= shard.size()) std::from_chars(&shard[place], &shard[place] + digits, number);
    return number;
  };
  const std::size_t first = std::string_view(shard_prefix).size();
  const std::uint64_t begin = number_at(first);
  const std::uint64_t end = number_at(first + digits + 1);
  return end > begin ? end - begin : 0;
}

std::uint64_t trials_of(const std::vector<fs::path>& shards) {
  std::uint64_t trials = 0;
  for (const fs::path& file : shards) trials += trials_of(file.filename().string());
  return trials;
}

/// Trials of a result that are those of `study` too. @throws RunFailure where they are not
FinishedTrials trials_for(const Study& study, const std::string& version, const fs::path& file) {
  StoredStudy stored = read_result(file);
  if (stored.engine_version != version || !stored.has_metrics || !continues(study, stored.study)) {
    throw RunFailure(fmt::format("{} is not of a study that this one continues", file.string()));
  }
  return {std::move(stored.result.trials), stored.result.wall_s};
}

fs::path unused_name(const fs::path& wanted) {
  fs::path name = wanted;
  for (unsigned count = 2; is_there(name); ++count) name = wanted.string() + fmt::format("-{}", count);
  return name;
}

}  // namespace

void StudyHome::create(const Study& study, const StudyRecord& made, const StudyHome* earlier) const {
  try {
    StudyDirectory directory(path_);
    write_record(record(), made);
    if (earlier != nullptr) link_from(*earlier);
    directory.begin(study);  // last: with its file it is a study; the links are on the disk with it
  } catch (...) {
    std::error_code ignored;  // what is left is no study, or is removed at the next start
    fs::remove(path_ / study_file, ignored);
    fs::remove_all(path_, ignored);
    throw;
  }
}

void StudyHome::link_from(const StudyHome& earlier) const {
  // The results last: where one takes the place of shards meanwhile, those missed are in it.
  for (const fs::path& file : files_in(earlier.path_, {shard_prefix, earlier_prefix})) {
    link_or_copy(file, path_ / file.filename());
  }
  for (const fs::path& file : earlier.launched_shards()) link_or_copy(file, path_ / file.filename());
  const std::string id = earlier.path_.filename().string();
  if (is_there(earlier.launched_result())) {
    link_or_copy(earlier.launched_result(), path_ / fmt::format("{}{}-launched.h5", earlier_prefix, id));
  }
  if (is_there(earlier.result())) {
    link_or_copy(earlier.result(), path_ / fmt::format("{}{}.h5", earlier_prefix, id));
  }
}

bool StudyHome::holds_study() const {
  return is_there(path_ / study_file) || is_there(result());
}

StoredStudy StudyHome::study() const {
  try {
    return read_result(path_ / study_file);
  } catch (const RunFailure&) {
    if (!is_there(result())) throw;
    StoredStudy stored = read_result(result());
    stored.result = {};
    stored.parameters.clear();
    return stored;
  }
}

std::uint64_t StudyHome::trials_in_shards() const {
  return trials_of(files_in(path_, {shard_prefix}));
}

std::uint64_t StudyHome::launched_trials() const {
  return trials_of(launched_shards());
}

/// It is another process's directory, which may go at any moment.
std::vector<fs::path> StudyHome::launched_shards() const {
  try {
    return files_in(launched_parts(), {shard_prefix});
  } catch (const RunFailure&) {
    return {};
  }
}

KeptStudy StudyHome::read(const Study& study, const ShardOrigin& origin,
                          std::vector<std::vector<double>>* parameters) const {
  if (is_there(result())) {
    StoredStudy stored = read_result(result());
    if (parameters != nullptr) *parameters = std::move(stored.parameters);
    return {std::move(stored.result), std::move(stored.engine_version)};
  }
  const std::uint64_t trials = Plan(study).trials();
  FinishedTrials all;
  for (const fs::path& file : files_in(path_, {shard_prefix, earlier_prefix})) {
    try {
      const bool is_shard = file.filename().string().starts_with(shard_prefix);
      all = joined(std::move(all), is_shard ? finished_trials(read_shard(file, origin, trials))
                                            : trials_for(study, origin.engine_version, file));
    } catch (const RunFailure&) {  // its next run tells, and runs those trials again
    }
  }
  if (is_there(launched_parts()) || is_there(launched_result())) {
    all = joined(std::move(all), launched_finished(study, origin));
  }
  KeptStudy kept;
  kept.result.trials = std::move(all.trials);
  kept.result.wall_s = all.wall_s;
  kept.engine_version = origin.engine_version;
  return kept;
}

/// What is run through a launcher, at any moment of its life: what is being replaced meanwhile is passed over.
FinishedTrials StudyHome::launched_finished(const Study& study, const ShardOrigin& origin) const {
  FinishedTrials all;
  try {
    if (is_there(launched_result())) all = trials_for(study, origin.engine_version, launched_result());
    const std::uint64_t trials = Plan(study).trials();
    for (const fs::path& file : launched_shards()) {
      all = joined(std::move(all), finished_trials(read_shard(file, origin, trials)));
    }
  } catch (const RunFailure&) {
  }
  return all;
}

FinishedTrials StudyHome::recover(StudyDirectory& directory, const Study& study,
                                  const std::function<void(const std::string&)>& tell) const {
  Recovery recovery = directory.recover();
  for (const SetAside& aside : recovery.set_aside) {
    tell(fmt::format("{}; renamed it to {}, its trials run again", aside.reason, aside.file.string()));
  }
  FinishedTrials all = std::move(recovery.finished);
  for (const fs::path& file : files_in(path_, {earlier_prefix})) {
    try {
      all = joined(std::move(all), trials_for(study, origin_of(study).engine_version, file));
    } catch (const RunFailure& damage) {
      remove_file(file);
      tell(fmt::format("{}; its trials run again", damage.what()));
    }
  }
  return all;
}

void StudyHome::hand_to_launched(StudyDirectory& directory, const Study& study,
                                 const std::function<void(const std::string&)>& tell) const {
  constexpr std::uint64_t most_trials = std::uint64_t{1} << 20;  // a shard
  const FinishedTrials known = recover(directory, study, tell);
  if (known.trials.index.empty()) return;
  StudyDirectory parts(launched_parts());
  parts.begin(study);
  const double each_s = known.wall_s / static_cast<double>(known.trials.index.size());
  std::span<const TrialOutcome> left(known.trials.outcomes);
  for (const TrialRange& range : known.ranges()) {
    for (std::uint64_t begin = range.begin; begin < range.end;) {
      const auto outcomes = left.first(std::min(range.end - begin, most_trials));
      parts.keep(begin, outcomes, each_s * static_cast<double>(outcomes.size()));
      left = left.subspan(outcomes.size());
      begin += outcomes.size();
    }
  }
  for (const fs::path& file : files_in(path_, {shard_prefix, earlier_prefix})) remove_file(file);
}

std::optional<StudyResult> StudyHome::whole_result(const Study& study) const {
  if (!is_there(result())) return std::nullopt;
  StoredStudy stored = read_result(result());
  if (!stored.result.complete || spec_sha256(stored.study) != spec_sha256(study)) return std::nullopt;
  return std::move(stored.result);
}

void StudyHome::forget_earlier() const {
  for (const fs::path& file : files_in(path_, {earlier_prefix})) remove_file(file);
}

void StudyHome::forget_launched() const {
  for (const fs::path& file : {launched_spec(), launched_log(), launched_note()}) remove_file(file);
}

void StudyHome::forget_partial_result() const {
  remove_file(partial_result());
}

void StudyHome::clear_temporaries() const {
  for (const fs::path& file : files_in(path_, {temporary_prefix})) remove_file(file);
}

void StudyHome::remove() const {
  const fs::path doomed = unused_name(path_.parent_path() / (removed_prefix + path_.filename().string()));
  std::error_code error;
  fs::rename(path_, doomed, error);
  if (error) fail_at("remove", path_, error);
  sync_directory(path_.parent_path());
  fs::remove_all(doomed, error);  // what is left goes at the next start
}

fs::path StudyHome::set_aside() const {
  fs::path name = unused_name(path_.parent_path() / (damaged_prefix + path_.filename().string()));
  std::error_code error;
  fs::rename(path_, name, error);
  if (error) fail_at("rename", path_, error);
  return name;
}

}  // namespace steerstat
