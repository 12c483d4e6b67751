#include "api/request_metrics.hpp"

#include <fmt/format.h>

#include <iterator>
#include <string_view>

namespace steerstat {
namespace {

using Inserter = std::back_insert_iterator<std::string>;

/// The two lines that begin a family. @param type  counter, gauge or histogram
void begin_family(std::string& text, std::string_view name, std::string_view type, std::string_view help) {
  fmt::format_to(Inserter(text), "# HELP {} {}\n# TYPE {} {}\n", name, help, name, type);
}

template <class Value>
void add_single(std::string& text, std::string_view name, std::string_view type, std::string_view help, Value value) {
  begin_family(text, name, type, help);
  fmt::format_to(Inserter(text), "{} {}\n", name, value);
}

}  // namespace

void RequestMetrics::observe(const std::string& route, const std::string& method, int status, double seconds) {
  const std::lock_guard lock(mutex_);
  ++requests_[{route, method, status}];
  Latencies& latencies = latencies_[route];
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    if (seconds <= bounds[i]) {
      ++latencies.counts[i];
      break;
    }
  }
  ++latencies.count;
  latencies.sum += seconds;
}

std::string RequestMetrics::text() const {
  const std::lock_guard lock(mutex_);
  std::string text;
  begin_family(text, "steerstat_http_requests_total", "counter", "Requests answered.");
  for (const auto& [key, count] : requests_) {
    fmt::format_to(Inserter(text), "steerstat_http_requests_total{{route=\"{}\",method=\"{}\",code=\"{}\"}} {}\n",
                   std::get<0>(key), std::get<1>(key), std::get<2>(key), count);
  }
  constexpr std::string_view name = "steerstat_http_request_duration_seconds";
  begin_family(text, name, "histogram", "Time from a whole request to its response being ready.");
  for (const auto& [route, latencies] : latencies_) {
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      below += latencies.counts[i];
      fmt::format_to(Inserter(text), "{}_bucket{{route=\"{}\",le=\"{}\"}} {}\n", name, route, bounds[i], below);
    }
    fmt::format_to(Inserter(text), "{}_bucket{{route=\"{}\",le=\"+Inf\"}} {}\n", name, route, latencies.count);
    fmt::format_to(Inserter(text), "{}_sum{{route=\"{}\"}} {}\n", name, route, latencies.sum);
    fmt::format_to(Inserter(text), "{}_count{{route=\"{}\"}} {}\n", name, route, latencies.count);
  }
  return text;
}

std::string metrics_text(const ServiceCounters& counters) {
  std::string text;
  add_single(text, "steerstat_trials_done_total", "counter", "Trials finished since the start.", counters.trials_done);
  add_single(text, "steerstat_trials_per_second", "gauge", "Rate of all running studies, of the last seconds.",
             counters.trials_per_s);
  add_single(text, "steerstat_queue_length", "gauge", "Studies that wait to run.",
             counters.studies[static_cast<std::size_t>(StudyStatus::queued)]);
  add_single(text, "steerstat_worker_threads", "gauge", "Trials' threads.", counters.threads);
  begin_family(text, "steerstat_studies", "gauge", "Studies that are kept, by status.");
  for (std::size_t i = 0; i < study_status_names.size(); ++i) {
    fmt::format_to(Inserter(text), "steerstat_studies{{status=\"{}\"}} {}\n", study_status_names[i],
                   counters.studies[i]);
  }
  return text;
}

std::string metrics_text(const DoorCounters& counters, std::size_t streams) {
  std::string text;
  add_single(text, "steerstat_http_requests_in_flight", "gauge", "Requests that are being answered.",
             counters.in_flight);
  add_single(text, "steerstat_http_connections_waiting", "gauge", "Connections without a whole request.",
             counters.waiting);
  add_single(text, "steerstat_http_event_streams", "gauge", "Streams of events that are open.", streams);
  begin_family(text, "steerstat_http_refused_total", "counter", "Requests refused at the door, by status.");
  for (const auto& [status, count] : counters.refused) {
    fmt::format_to(Inserter(text), "steerstat_http_refused_total{{code=\"{}\"}} {}\n", status, count);
  }
  return text;
}

}  // namespace steerstat
