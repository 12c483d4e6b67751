#pragma once

#include <stop_token>
#include <string>

#include "api/api.hpp"
#include "api/request_metrics.hpp"
#include "api/router.hpp"
#include "hardening/share.hpp"
#include "umbridge/models.hpp"

namespace steerstat {

/// What the routes stand on. Outlives them.
struct Surroundings {
  StudyService& service;
  ApiOptions options;
  Share streams{options.event_streams};
  Share downloads{options.downloads};
  Share computations{options.computations};
  Share evaluations{options.evaluations};
  Share summaries{options.summaries};
  Share readings{options.readings};
  Models models{service};
  RequestMetrics metrics{};
  std::stop_source stop{};
};

/// A place of a share. @throws Refused 503 with Retry-After where all are taken
std::shared_ptr<void> take_place(Share& share, const std::string& kind);

/// The id of a path. @throws Refused 404 where it cannot be one
const std::string& id_of(const Call& call);

/// What take_place() calls a computation.
inline constexpr const char* computation = "views, trajectories and comparisons";

/// The trial's index of a path, its second value. @throws Refused 404 where it cannot be one
std::uint64_t trial_of(const Call& call);

/// The state of a study. @throws NoSuchStudy
StudyState state_of(const StudyService& service, const std::string& id);

// Each adds the routes that it is named after.
void add_study_routes(Router& router, Surroundings& surroundings);
void add_trial_routes(Router& router, Surroundings& surroundings);
void add_result_route(Router& router, Surroundings& surroundings);
void add_event_route(Router& router, Surroundings& surroundings);
void add_view_routes(Router& router, Surroundings& surroundings);
void add_comparison_route(Router& router, Surroundings& surroundings);
void add_model_routes(Router& router, Surroundings& surroundings);
void add_document_routes(Router& router, Surroundings& surroundings);
void add_dashboard(Router& router, const Surroundings& surroundings);

}  // namespace steerstat
