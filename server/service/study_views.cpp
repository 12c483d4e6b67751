#include "service/study_views.hpp"

#include <utility>

#include "service/refresh_timer.hpp"

namespace steerstat {
namespace {

constexpr std::size_t most_views = 24;  // a megabyte or two a piece

}  // namespace

StudyViews::Text StudyViews::view(const std::string& id, std::uint64_t revision, bool is_running,
                                  const std::function<std::string()>& make) {
  if (auto found = find(id, revision, is_running)) return found;
  const std::lock_guard making(making_);
  if (auto found = find(id, revision, is_running)) return found;  // made while this one waited
  const RefreshTimer timer;
  Text text = std::make_shared<const std::string>(make());
  const Clock::time_point due = timer.due();
  const std::lock_guard lock(mutex_);
  made_.remove_if([&](const Made& one) { return one.id == id; });
  made_.push_front({id, revision, is_running, due, text});
  if (made_.size() > most_views) made_.pop_back();
  return text;
}

void StudyViews::forget(const std::string& id) {
  const std::lock_guard lock(mutex_);
  made_.remove_if([&](const Made& one) { return one.id == id; });
}

StudyViews::Text StudyViews::find(const std::string& id, std::uint64_t revision, bool is_running) {
  const std::lock_guard lock(mutex_);
  for (auto one = made_.begin(); one != made_.end(); ++one) {
    if (one->id != id) continue;
    const bool holds =
        is_running ? one->was_running && Clock::now() < one->due : !one->was_running && one->revision == revision;
    if (!holds) return nullptr;
    made_.splice(made_.begin(), made_, one);
    return one->text;
  }
  return nullptr;
}

}  // namespace steerstat
