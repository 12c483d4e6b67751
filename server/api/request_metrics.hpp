#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <tuple>

#include "hardening/http_server.hpp"
#include "service/service_counters.hpp"

namespace steerstat {

/// How requests were answered, by route, method and status. Thread-safe.
class RequestMetrics {
 public:
  /// Upper bounds of the buckets [s].
  static constexpr std::array<double, 12> bounds{0.001, 0.0025, 0.005, 0.01, 0.025, 0.05,
                                                 0.1,   0.25,   0.5,   1.0,  2.5,   10.0};

  /// @param route    its pattern, so that there are few
  /// @param seconds  until the response was ready to be sent
  void observe(const std::string& route, const std::string& method, int status, double seconds);

  /// As families of Prometheus' text format.
  [[nodiscard]] std::string text() const;

 private:
  struct Latencies {
    std::array<std::uint64_t, bounds.size()> counts{};  ///< each bucket alone
    std::uint64_t count{0};
    double sum{0.0};
  };
  mutable std::mutex mutex_;
  std::map<std::tuple<std::string, std::string, int>, std::uint64_t> requests_;
  std::map<std::string, Latencies> latencies_;
};

/// What a service does, as families of Prometheus' text format.
std::string metrics_text(const ServiceCounters& counters);

/// What comes to the door, likewise. @param streams  event streams that are open
std::string metrics_text(const DoorCounters& counters, std::size_t streams);

}  // namespace steerstat
