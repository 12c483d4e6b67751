#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>

namespace steerstat {

/// The views of studies that readers asked for last, as text, so that many who look at one study cost as much as one.
/// Thread-safe.
class StudyViews {
 public:
  using Clock = std::chrono::steady_clock;
  using Text = std::shared_ptr<const std::string>;

  /// @param revision    of the study: a view made at another one counts for nothing, but while it runs
  /// @param is_running  then a view holds for a while (RefreshTimer), whatever the revision
  /// @param make        makes it; one view is made at a time
  /// @throws what `make` throws
  Text view(const std::string& id, std::uint64_t revision, bool is_running, const std::function<std::string()>& make);

  void forget(const std::string& id);

 private:
  struct Made {
    std::string id;
    std::uint64_t revision;
    bool was_running;
    Clock::time_point due;  ///< when a running study's is made anew
    Text text;
  };

  Text find(const std::string& id, std::uint64_t revision, bool is_running);

  std::mutex making_{};
  std::mutex mutex_{};
  std::list<Made> made_{};  // the last used first
};

}  // namespace steerstat
