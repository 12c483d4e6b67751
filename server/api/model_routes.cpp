#include <fmt/format.h>
#include <httplib.h>

#include <memory>
#include <string>

#include "api/reply.hpp"
#include "api/routes.hpp"
#include "core/errors.hpp"
#include "service/service_errors.hpp"
#include "umbridge/models.hpp"

namespace steerstat {
namespace {

/// Says in the protocol's words, which clients look for whatever the status, that it is not the question's fault.
void refuse(httplib::Response& response, const std::string& why, unsigned retry_after) {
  const ModelReply reply = reply_of({ModelRefusal::unavailable, why}, 503);
  response.set_header("Retry-After", std::to_string(retry_after));
  reply_json(response, reply.json, "", reply.status);
}

void answer(Surroundings& surroundings, const std::string& action, const Call& call, httplib::Response& response) {
  const std::shared_ptr<void> place = surroundings.evaluations.take();
  if (!place) {
    refuse(response, "as many evaluations of models as may are under way; try again later", 5);
    return;
  }
  try {
    const ModelReply reply = surroundings.models.answer(action, call.request.body);
    reply_json(response, reply.json, "", reply.status);
  } catch (const QueueFull& full) {
    refuse(response, full.what(), full.retry_after());
  } catch (const RunFailure& failure) {  // most often a full disk
    refuse(response, failure.what(), 60);
  }
}

}  // namespace

void add_model_routes(Router& router, Surroundings& surroundings) {
  router.add("GET", "/Info", [](const Call&, httplib::Response& response) { reply_json(response, Models::info()); });
  for (const std::string action :
       {"ModelInfo", "InputSizes", "OutputSizes", "Evaluate", "Gradient", "ApplyJacobian", "ApplyHessian"}) {
    // Whatever Content-Type the request has: several clients give none. What keeps other sites' pages out is the door.
    router.add("POST", fmt::format("/{}", action),
               [&surroundings, action](const Call& call, httplib::Response& response) {
                 answer(surroundings, action, call, response);
               });
  }
}

}  // namespace steerstat
