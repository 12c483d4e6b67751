#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "service/live_outcomes.hpp"
#include "service/study_demand.hpp"
#include "service/study_home.hpp"
#include "service/study_record.hpp"
#include "service/study_state.hpp"
#include "store/shard.hpp"
#include "study/run.hpp"
#include "study/study.hpp"

namespace steerstat {

/// What the process knows of a study. All that changes but the caches is guarded by the Catalogue, which gives access.
struct StudyEntry {
  using Clock = std::chrono::steady_clock;

  StudyEntry(std::string identity, std::shared_ptr<const Study> value, StudyHome place, ShardOrigin of_shards,
             StudyRecord known)
      : id(std::move(identity)),
        study(std::move(value)),
        home(std::move(place)),
        origin(std::move(of_shards)),
        demand(demand_of(*study)),
        record(std::move(known)) {}

  const std::string id;
  const std::shared_ptr<const Study> study;
  const StudyHome home;
  const ShardOrigin origin;
  const StudyDemand demand;

  StudyRecord record;
  /// What a run adds to it.
  struct Run {
    std::stop_source stop{};
    std::stop_source give_up{};
    Clock::time_point began{Clock::now()};
    Clock::time_point given_up_at{Clock::time_point::max()};  ///< if it has not ended by then
    bool is_cancelled{false};                                 ///< a client asked for its end
    bool is_overtime{false};                                  ///< it ran as long as it may
    std::optional<double> trials_per_s{};
    unsigned threads{0};                         ///< workers
    double earlier_wall_s{0.0};                  ///< [s] that its earlier runs took
    std::shared_ptr<const LiveOutcomes> live{};  ///< from when its trials are to be seen
    std::shared_ptr<const KeptStudy> result{};   ///< from its end on, until it is on the disk
  };
  std::optional<Run> run;  ///< while it runs

  std::mutex keeping{};  ///< held by who writes the record

  /// Summaries of what is not over, and of what is over without being whole.
  struct SummaryCache {
    std::mutex mutex{};      ///< of the two below
    std::mutex computing{};  ///< held by who makes one
    std::string json{};      ///< "": none yet
    std::uint64_t revision{0};
    bool was_running{false};
    Clock::time_point due{};  ///< when a running study's is made anew
  };
  mutable SummaryCache summaries{};

  /// The partial result on the disk.
  struct PartialResult {
    std::mutex mutex{};
    std::uint64_t revision{0};  ///< of the study, when it was written by this process
  };
  mutable PartialResult partial{};
};

}  // namespace steerstat
