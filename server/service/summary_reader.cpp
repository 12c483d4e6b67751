#include <span>

#include "core/errors.hpp"
#include "report/summary.hpp"
#include "service/refresh_timer.hpp"
#include "service/study_reader.hpp"
#include "service/study_service.hpp"
#include "store/seal.hpp"
#include "store/whole_file.hpp"

namespace steerstat {
namespace {

using Clock = StudyEntry::Clock;

/// What the cache has for a study in this state, if it still holds. Called with the cache's mutex.
std::optional<SummaryText> cached(const StudyEntry::SummaryCache& cache, const StudyState& state) {
  if (cache.json.empty()) return std::nullopt;
  const bool is_running = state.status == StudyStatus::running;
  const bool holds = is_running ? cache.was_running && Clock::now() < cache.due
                                : !cache.was_running && cache.revision == state.revision;
  if (!holds) return std::nullopt;
  return SummaryText{cache.json, state.status == StudyStatus::succeeded, cache.revision};
}

}  // namespace

/// The summary that was written with the result, where it is as it was written.
std::optional<std::string> StudyReader::kept_summary(const StudyEntry& entry) const {
  const auto seal = catalogue_.look(entry, [](const StudyEntry& now) { return now.record.summary_seal; });
  if (!seal) return std::nullopt;
  try {
    const std::vector<std::byte> bytes = read_whole_file(entry.home.summary());
    if (seal_of(bytes) != *seal) return std::nullopt;
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  } catch (const RunFailure&) {
    return std::nullopt;
  }
}

SummaryText StudyReader::summary(const StudyEntry& entry) {
  const StudyState state = catalogue_.state(entry);
  if (state.status == StudyStatus::succeeded) {
    if (auto json = kept_summary(entry)) return {*std::move(json), true, state.revision};
  }
  StudyEntry::SummaryCache& cache = entry.summaries;
  const auto find = [&] {
    const std::lock_guard lock(cache.mutex);
    return cached(cache, state);
  };
  if (auto found = find()) return *std::move(found);
  std::unique_lock computing(cache.computing, std::try_to_lock);
  if (!computing) {
    // Another caller makes it anew: all but the first are content with the one before, if there is one.
    if (state.status == StudyStatus::running) {
      const std::lock_guard lock(cache.mutex);
      if (!cache.json.empty() && cache.was_running) return {cache.json, false, cache.revision};
    }
    computing.lock();
  }
  if (auto found = find()) return *std::move(found);  // made while this one waited
  const RefreshTimer timer;
  std::string json = summary_json(summarise(*entry.study, everything(entry)->result));
  const std::lock_guard lock(cache.mutex);
  cache.json = std::move(json);
  cache.revision = state.revision;
  cache.was_running = state.status == StudyStatus::running;
  cache.due = timer.due();
  return {cache.json, state.status == StudyStatus::succeeded, cache.revision};
}

}  // namespace steerstat
