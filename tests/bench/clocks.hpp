#pragma once

#include <algorithm>
#include <ctime>
#include <utility>
#include <vector>

namespace steerstat::bench {

inline double seconds_on(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// What something took [s].
struct Duration {
  double wall{0.0};
  double cpu{0.0};  ///< of all threads of this process: what others do on the machine shows less
};

template <class Work>
Duration time_of(Work&& work) {
  const double wall = seconds_on(CLOCK_MONOTONIC);
  const double cpu = seconds_on(CLOCK_PROCESS_CPUTIME_ID);
  std::forward<Work>(work)();
  return {seconds_on(CLOCK_MONOTONIC) - wall, seconds_on(CLOCK_PROCESS_CPUTIME_ID) - cpu};
}

/// The middle value, the mean of the middle two. @param values  at least one
inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

}  // namespace steerstat::bench
