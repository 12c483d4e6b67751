#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "service/service_counters.hpp"
#include "service/study_entry.hpp"

namespace steerstat {

/// The studies that the process knows, and who waits for them to change. Thread-safe; nothing here touches the disk.
class Catalogue {
 public:
  using Entry = std::shared_ptr<StudyEntry>;

  void insert(const Entry& entry);
  void erase(const StudyEntry& entry);

  /// @return null where there is none
  [[nodiscard]] Entry find(const std::string& id) const;

  /// The study with the most finished trials among those whose trials are those of `origin`, and that pass.
  [[nodiscard]] Entry find_related(const ShardOrigin& origin,
                                   const std::function<bool(const StudyEntry&)>& passes) const;

  /// Newest first. @param cursor  where a page before this one ended, or empty
  struct Page {
    std::vector<StudyState> states;
    std::optional<std::string> next;
  };
  [[nodiscard]] Page page(std::size_t limit, std::string_view cursor) const;

  [[nodiscard]] StudyState state(const StudyEntry& entry) const;

  /// Looks at what changes of an entry, undisturbed. @return what `look` returns
  template <class Look>
  auto look(const StudyEntry& entry, const Look& look) const {
    const std::lock_guard lock(mutex_);
    return look(entry);
  }

  /// Changes an entry, so that clients see it: its revision grows, unless `change` has set another one.
  /// @return what `change` returns
  template <class Change>
  auto change(StudyEntry& entry, const Change& change) {
    struct Announced {
      Catalogue& catalogue;
      StudyEntry& changed;
      std::uint64_t before;
      ~Announced() {
        if (changed.record.revision == before) changed.record.revision = next_revision(before);
        catalogue.changed_.notify_all();
      }
    };
    const std::lock_guard lock(mutex_);
    const Announced announced{*this, entry, entry.record.revision};
    return change(entry);
  }

  /// Waits until the entry is of another revision or gone, at most so long; not after close().
  /// @return nothing where it is gone
  [[nodiscard]] std::optional<StudyState> wait(const std::string& id, std::uint64_t revision,
                                               std::chrono::milliseconds timeout, const std::stop_token& stop) const;

  /// Waits until the run that is under way, if one is, has ended; at most so long. @return the state then
  StudyState wait_for_end(const StudyEntry& entry, std::chrono::milliseconds timeout) const;

  /// Wakes all who wait, and lets nobody wait() any more.
  void close();

  /// All but trials_done and threads.
  [[nodiscard]] ServiceCounters counters() const;

 private:
  using Age = std::pair<std::string, std::string>;  // created, id

  mutable std::mutex mutex_{};
  mutable std::condition_variable_any changed_{};
  std::map<std::string, Entry> by_id_{};
  std::map<Age, Entry> by_age_{};
  std::multimap<std::string, Entry> by_trials_{};  // key: trials_sha256 of their shards
  bool closed_{false};
};

}  // namespace steerstat
