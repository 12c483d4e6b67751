#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace steerstat {

/// How much of the machine the service lets its studies have. What a spec asks for beyond that is refused with a
/// LimitExceeded; decode_study() has limits of its own (study/limits.hpp).
struct ServiceLimits {
  std::uint64_t trials{10'000'000};        ///< in all cells of a study together
  std::uint64_t cells{2'000};              ///< of a study's sweeps; each is some 4 kB of every summary
  double horizon{20'000.0};                ///< [s] of a trial: seconds with CVODE
  std::size_t spec_bytes{1U << 20U};       ///< of a spec as it was sent
  std::chrono::seconds wall_time{86'400};  ///< that a study may run, waiting for its turns included; it fails then
  /// That blocks in flight have to end in, once their study is cancelled or has run as long as it may, and once the
  /// service stops. Those of trials that take longer are given up, and computed again if the study goes on.
  std::chrono::milliseconds ending_time{5'000};
  std::chrono::milliseconds stopping_time{30'000};
  /// That a client who cancels a study waits for that, and one who submits a study that is being cancelled.
  std::chrono::milliseconds cancelling_time{10'000};
  std::chrono::milliseconds replaying_time{15'000};  ///< that one trial may take while a client waits for it
  std::size_t queued_studies{100};                   ///< that wait to run; one more is refused with QueueFull
  std::size_t running_studies{8};                    ///< at once, sharing the processors by blocks
  std::size_t places_for_small{2};    ///< of those, kept free of studies with more trials than small_study
  std::uint64_t small_study{20'000};  ///< trials
  std::uint64_t memory{0};            ///< [bytes] that running studies may need together; 0: half of the machine's
  std::uint64_t disk_headroom{std::uint64_t{256} << 20U};   ///< [bytes] to be free beside what a study needs
  std::uint64_t opened_results{std::uint64_t{512} << 20U};  ///< [bytes] of finished studies kept in memory for readers
};

}  // namespace steerstat
