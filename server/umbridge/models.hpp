#pragma once

#include <string>
#include <string_view>

#include "service/study_service.hpp"
#include "umbridge/study_model.hpp"
#include "umbridge/trial_model.hpp"

namespace steerstat {

/// What a client of UM-Bridge gets.
struct ModelReply {
  int status{200};   ///< of HTTP
  std::string json;  ///< without any key that the protocol does not know
};

/// The answer to a client whose question is refused.
ModelReply reply_of(const ModelRefusal& refusal, int status = 400);

/// The service's models behind the UM-Bridge protocol 1.0 [UM-Bridge], all but HTTP: `trial` and `study`. Thread-safe.
class Models {
 public:
  /// @param service  must outlive this
  explicit Models(StudyService& service)
      : trial_(service.limits().horizon, service.limits().replaying_time), study_(service) {}

  /// GET /Info.
  [[nodiscard]] static std::string info();

  /// POST to `/ACTION`: ModelInfo, InputSizes, OutputSizes, Evaluate; Gradient, ApplyJacobian and ApplyHessian are
  /// unsupported. The model's name is looked at before its input.
  /// @param body  JSON, whatever the request calls it: several clients do not say
  /// @throws QueueFull, RunFailure, and what is a mistake of ours
  [[nodiscard]] ModelReply answer(std::string_view action, std::string_view body) const;

 private:
  [[nodiscard]] const Model& model(const Json& request) const;
  [[nodiscard]] Json result_of(std::string_view action, const Json& request) const;

  TrialModel trial_;
  StudyModel study_;
};

}  // namespace steerstat
