#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "service/study_state.hpp"

namespace steerstat {

/// What a service has done and has to do.
struct ServiceCounters {
  std::uint64_t trials_done{0};                                  ///< since the start of the process
  double trials_per_s{0.0};                                      ///< of all running studies, of the last seconds
  std::array<std::size_t, study_status_names.size()> studies{};  ///< by StudyStatus; queued is the queue's length
  unsigned threads{0};                                           ///< workers at once
};

}  // namespace steerstat
