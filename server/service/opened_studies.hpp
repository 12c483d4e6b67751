#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "service/study_home.hpp"

namespace steerstat {

/// Finished trials of the studies that readers asked for last, in memory. Thread-safe.
class OpenedStudies {
 public:
  /// @param bytes  they may take together; the last one asked for may take more, alone
  explicit OpenedStudies(std::uint64_t bytes) : most_(bytes) {}

  /// @param revision  of the study: what was read at another one counts for nothing
  /// @param read      reads it from the disk; one study is read at a time
  /// @throws what `read` throws
  std::shared_ptr<const KeptStudy> open(const std::string& id, std::uint64_t revision,
                                        const std::function<KeptStudy()>& read);

  /// @return null where it is not in memory
  std::shared_ptr<const KeptStudy> find(const std::string& id, std::uint64_t revision);

  void forget(const std::string& id);

 private:
  struct Opened {
    std::string id;
    std::uint64_t revision;
    std::uint64_t bytes;
    std::shared_ptr<const KeptStudy> study;
  };

  void remember(Opened opened);

  const std::uint64_t most_;
  std::mutex reading_{};
  std::mutex mutex_{};
  std::list<Opened> opened_{};  // the last used first
};

}  // namespace steerstat
