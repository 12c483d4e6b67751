#include "service/catalogue.hpp"

#include "core/errors.hpp"

namespace steerstat {
namespace {

constexpr char separator = '~';

StudyState state_of(const StudyEntry& entry) {
  const StudyRecord& record = entry.record;
  StudyState state;
  state.id = entry.id;
  state.name = entry.study->name;
  state.status = record.status;
  state.completed = record.completed;
  state.requested = entry.demand.trials;
  state.created = record.created;
  state.started = record.started;
  state.finished = record.finished;
  state.failure = record.failure;
  state.revision = record.revision;
  if (entry.run) {
    state.status = StudyStatus::running;
    state.trials_per_s = entry.run->trials_per_s;
    if (state.trials_per_s.value_or(0.0) > 0.0) {
      state.eta_s = static_cast<double>(state.requested - state.completed) / *state.trials_per_s;
    }
  }
  return state;
}

}  // namespace

void Catalogue::insert(const Entry& entry) {
  const std::lock_guard lock(mutex_);
  by_id_.emplace(entry->id, entry);
  by_age_.emplace(Age{entry->record.created, entry->id}, entry);
  by_trials_.emplace(entry->origin.trials_sha256, entry);
  changed_.notify_all();
}

void Catalogue::erase(const StudyEntry& entry) {
  const std::lock_guard lock(mutex_);
  const auto found = by_id_.find(entry.id);
  if (found == by_id_.end()) return;
  const Entry kept = found->second;  // until the last line
  by_id_.erase(found);
  by_age_.erase(Age{entry.record.created, entry.id});
  const auto [first, last] = by_trials_.equal_range(entry.origin.trials_sha256);
  for (auto one = first; one != last; ++one) {
    if (one->second == kept) {
      by_trials_.erase(one);
      break;
    }
  }
  changed_.notify_all();
}

Catalogue::Entry Catalogue::find(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto found = by_id_.find(id);
  return found == by_id_.end() ? nullptr : found->second;
}

Catalogue::Entry Catalogue::find_related(const ShardOrigin& origin,
                                         const std::function<bool(const StudyEntry&)>& passes) const {
  const std::lock_guard lock(mutex_);
  Entry best;
  const auto [first, last] = by_trials_.equal_range(origin.trials_sha256);
  for (auto one = first; one != last; ++one) {
    const StudyEntry& entry = *one->second;
    if (entry.origin != origin || !passes(entry)) continue;
    if (entry.record.completed > (best ? best->record.completed : 0)) best = one->second;
  }
  return best;
}

Catalogue::Page Catalogue::page(std::size_t limit, std::string_view cursor) const {
  const std::lock_guard lock(mutex_);
  auto end = by_age_.end();  // the page holds those before it, from the last down
  if (!cursor.empty()) {
    const std::size_t place = cursor.find(separator);
    if (place == std::string_view::npos) {
      throw BadUsage("the cursor is none of ours (the \"next\" of an earlier page); leave it out for the first page");
    }
    end = by_age_.lower_bound({std::string(cursor.substr(0, place)), std::string(cursor.substr(place + 1))});
  }
  Page page;
  while (end != by_age_.begin() && page.states.size() < limit) page.states.push_back(state_of(*(--end)->second));
  if (end != by_age_.begin() && !page.states.empty()) {
    page.next = end->first.first + separator + end->first.second;
  }
  return page;
}

StudyState Catalogue::state(const StudyEntry& entry) const {
  const std::lock_guard lock(mutex_);
  return state_of(entry);
}

std::optional<StudyState> Catalogue::wait(const std::string& id, std::uint64_t revision,
                                          std::chrono::milliseconds timeout, const std::stop_token& stop) const {
  std::unique_lock lock(mutex_);
  const auto changed = [&] {
    const auto found = by_id_.find(id);
    return closed_ || found == by_id_.end() || found->second->record.revision != revision;
  };
  changed_.wait_for(lock, stop, timeout, changed);
  const auto found = by_id_.find(id);
  if (found == by_id_.end()) return std::nullopt;
  return state_of(*found->second);
}

StudyState Catalogue::wait_for_end(const StudyEntry& entry, std::chrono::milliseconds timeout) const {
  std::unique_lock lock(mutex_);
  if (entry.run) {
    const auto began = entry.run->began;
    changed_.wait_for(lock, timeout, [&] { return !entry.run || entry.run->began != began; });
  }
  return state_of(entry);
}

void Catalogue::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

ServiceCounters Catalogue::counters() const {
  ServiceCounters counters;
  const std::lock_guard lock(mutex_);
  for (const auto& [id, entry] : by_id_) {
    const StudyState state = state_of(*entry);
    ++counters.studies[static_cast<std::size_t>(state.status)];
    counters.trials_per_s += state.trials_per_s.value_or(0.0);
  }
  return counters;
}

}  // namespace steerstat
