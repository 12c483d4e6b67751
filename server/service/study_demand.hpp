#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "service/service_limits.hpp"
#include "study/study.hpp"

namespace steerstat {

/// What a study asks of the machine.
struct StudyDemand {
  std::uint64_t trials{0};
  std::uint64_t memory{0};  ///< [bytes] at its end, when the result is made
  std::uint64_t disk{0};    ///< [bytes] shards and result
};

/// An estimate, on the high side.
StudyDemand demand_of(const Study& study);

/// A study that waits.
struct WaitingStudy {
  StudyDemand demand;
  unsigned overtaken{0};  ///< how many studies that came later began before it
};

/// One that waits for memory lets at most so many pass.
inline constexpr unsigned most_overtaken = 16;

/// Which study of a queue is to begin now: the first that fits. A place is free where fewer than running_studies run,
/// and, for one that is not small, where fewer than those less places_for_small run that are not small either. One that
/// alone needs more memory than there is for all has it alone.
///
/// @param queue    in the order of coming
/// @param running  those that run
/// @param memory   [bytes] that they may need together
/// @return its position in the queue
std::optional<std::size_t> next_to_begin(std::span<const WaitingStudy> queue, std::span<const StudyDemand> running,
                                         const ServiceLimits& limits, std::uint64_t memory);

}  // namespace steerstat
