#include <fmt/format.h>
#include <httplib.h>

#include "api/reply.hpp"
#include "api/routes.hpp"
#include "umbridge/models.hpp"

namespace steerstat {

void add_model_routes(Router& router, Surroundings& surroundings) {
  router.add("GET", "/Info", [](const Call&, httplib::Response& response) { reply_json(response, Models::info()); });
  for (const std::string action :
       {"ModelInfo", "InputSizes", "OutputSizes", "Evaluate", "Gradient", "ApplyJacobian", "ApplyHessian"}) {
    // Whatever Content-Type the request has: several clients give none. What keeps other sites' pages out is the door.
    router.add("POST", fmt::format("/{}", action),
               [&surroundings, action](const Call& call, httplib::Response& response) {
                 const auto place = take_place(surroundings.evaluations, "evaluations of models");
                 const ModelReply reply = surroundings.models.answer(action, call.request.body);
                 reply_json(response, reply.json, "", reply.status);
               });
  }
}

}  // namespace steerstat
