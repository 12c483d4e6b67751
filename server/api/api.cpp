#include "api/api.hpp"

#include <fmt/format.h>
#include <httplib.h>

#include <algorithm>
#include <chrono>
#include <string_view>

#include "api/acceptance.hpp"
#include "api/reply.hpp"
#include "api/routes.hpp"
#include "report/pairing.hpp"
#include "report/readable.hpp"

namespace steerstat {
namespace {

using Clock = std::chrono::steady_clock;

/// The media type that a route answers with; "" of the page's files and of UM-Bridge, whose clients may say what they
/// like.
std::string_view type_of(std::string_view pattern) {
  if (pattern.ends_with("/events")) return "text/event-stream";
  if (pattern.ends_with("/results.h5")) return "application/x-hdf5";
  if (pattern == "/metrics") return "text/plain";
  const bool is_json = pattern.starts_with("/v1/") || pattern == "/openapi.json" || pattern == "/healthz";
  return is_json ? "application/json" : "";
}

/// @throws Refused 406 where the client does not take what the route answers with
void require_acceptable(const Router::Route& route, const httplib::Request& request) {
  const std::string_view type = type_of(route.pattern);
  std::string accept;
  const auto [first, last] = request.headers.equal_range("Accept");
  for (auto field = first; field != last; ++field) accept += (accept.empty() ? "" : ", ") + field->second;
  if (!type.empty() && !accepts(accept, type)) {
    throw Refused({406, fmt::format("this is {}, which Accept does not name; add it, or */*", type), {}, {}});
  }
}

/// Answers, with what the service throws as the problem that it is to a client.
void call(const Router::Route& route, const Call& request, httplib::Response& response) {
  try {
    route.handler(request, response);
  } catch (const BadSpec& bad) {
    throw Refused({422, counted(bad.errors().size(), "mistake") + " in the document", bad.errors(), {}});
  } catch (const LimitExceeded& excess) {
    throw Refused({422, "the study is more than the service takes", excess.errors(), {}});
  } catch (const QueueFull& full) {
    throw Refused({503, full.what(), {}, {{"Retry-After", std::to_string(full.retry_after())}}});
  } catch (const TakesTooLong& slow) {
    throw Refused({503, slow.what(), {}, {{"Retry-After", "60"}}});
  } catch (const NoSuchStudy& missing) {
    throw Refused({404, missing.what(), {}, {}});
  } catch (const NoSuchTrial& missing) {
    throw Refused({404, missing.what(), {}, {}});
  } catch (const StudiesDoNotPair& strangers) {
    std::vector<SpecError> errors;
    for (const std::string& reason : strangers.reasons()) errors.push_back({"", reason});
    throw Refused({422, "the studies cannot be compared trial by trial", std::move(errors), {}});
  } catch (const BadUsage& bad) {
    throw Refused({400, bad.what(), {}, {}});
  } catch (const RunFailure& failure) {
    throw Refused({500, failure.what(), {}, {}});
  }
}

}  // namespace

std::shared_ptr<void> take_place(Share& share, const std::string& kind) {
  std::shared_ptr<void> place = share.take();
  if (!place)
    throw Refused({503, "as many " + kind + " as may are under way; try again later", {}, {{"Retry-After", "5"}}});
  return place;
}

const std::string& id_of(const Call& call) {
  const std::string& id = call.values.front();
  const auto fits = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); };
  if (id.empty() || id.size() > 32 || !std::all_of(id.begin(), id.end(), fits)) {
    throw Refused({404, "there is no such study (ids are of 1 to 32 small letters and digits)", {}, {}});
  }
  return id;
}

StudyState state_of(const StudyService& service, const std::string& id) {
  std::optional<StudyState> state = service.state(id);
  if (!state) throw NoSuchStudy(id);
  return std::move(*state);
}

class Api::Implementation {
 public:
  Implementation(StudyService& service, ApiOptions options) : surroundings_{service, std::move(options)} {
    add_study_routes(router_, surroundings_);
    add_trial_routes(router_, surroundings_);
    add_result_route(router_, surroundings_);
    add_event_route(router_, surroundings_);
    add_view_routes(router_, surroundings_);
    add_comparison_route(router_, surroundings_);
    add_model_routes(router_, surroundings_);
    add_document_routes(router_, surroundings_);
    add_dashboard(router_, surroundings_);
  }

  void answer(const httplib::Request& request, httplib::Response& response) {
    const Clock::time_point begin = Clock::now();
    std::string route = "none";
    try {
      const Router::Match match = router_.find(request.method, request.path);
      route = match.route->pattern;
      require_acceptable(*match.route, request);
      call(*match.route, {request, match.values}, response);
    } catch (const Refused& refused) {
      answer_with(response, refused.problem());
    }
    secure(response);
    const std::chrono::duration<double> took = Clock::now() - begin;
    // Methods are the client's words: of those that lead nowhere there could be any number.
    const std::string method = route == "none" ? "any" : request.method;
    surroundings_.metrics.observe(route, method, response.status == -1 ? 200 : response.status, took.count());
  }

  Surroundings surroundings_;

 private:
  Router router_;
};

Api::Api(StudyService& service, ApiOptions options)
    : implementation_(std::make_unique<Implementation>(service, std::move(options))) {}

Api::~Api() = default;

void Api::answer(const httplib::Request& request, httplib::Response& response) {
  implementation_->answer(request, response);
}

void Api::stop() {
  implementation_->surroundings_.stop.request_stop();
}

}  // namespace steerstat
