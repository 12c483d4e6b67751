#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hardening/http_server.hpp"
#include "service/study_service.hpp"

namespace steerstat {

/// A file of the dashboard.
struct Asset {
  std::string_view path;  ///< "/", "/page.js"
  std::string_view type;  ///< "text/html; charset=utf-8"
  std::string_view content;
};

struct ApiOptions {
  std::vector<Asset> assets{};  ///< the dashboard; without one for "/" a short page stands there
  /// Requests of a kind that may be answered at once, so that others find a worker free: 503 beyond. Fewer together
  /// than there are workers (DoorLimits).
  std::size_t event_streams{16};
  std::size_t downloads{8};
  std::size_t computations{12};          ///< of trajectories, comparisons and views
  std::size_t evaluations{8};            ///< of UM-Bridge models, each of which may wait for a study
  std::size_t summaries{16};             ///< of studies under way, each of which may wait for one that is being made
  std::size_t readings{16};              ///< of trials of studies that are over, whose files may have to be read first
  std::function<DoorCounters()> door{};  ///< for /metrics to tell of; may be empty
};

/// The HTTP API on a StudyService: every route of schemas/openapi.yaml. Thread-safe.
class Api {
 public:
  /// @param service  must outlive it
  Api(StudyService& service, ApiOptions options);
  ~Api();
  Api(const Api&) = delete;
  Api& operator=(const Api&) = delete;

  /// Answers a request. @throws Refused
  void answer(const httplib::Request& request, httplib::Response& response);

  /// Ends all streams of events.
  void stop();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace steerstat
