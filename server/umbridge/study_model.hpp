#pragma once

#include <chrono>

#include "service/study_service.hpp"
#include "umbridge/model.hpp"

namespace steerstat {

/// The model `study`: how often the controller works, as a function of its own parameters.
///
/// `config.study` is the id of a study of the service, or a spec. Input: values of the controller's parameters that
/// `config.inputs` names (controller.contraction.eta1 and eta2 unless given), in the place of those in the study.
/// Output: [success rate, lower, upper end of its interval].
///
/// Each evaluation is a study of the service like any other: it is kept, listed, and not run again for the same input.
class StudyModel final : public Model {
 public:
  /// @param service  must outlive this
  /// @param patience  how long an evaluation may take; its study goes on, so that a later one finds it
  explicit StudyModel(StudyService& service, std::chrono::seconds patience = std::chrono::minutes(10))
      : service_(service), patience_(patience) {}

  [[nodiscard]] std::string_view name() const override { return "study"; }
  [[nodiscard]] std::size_t inputs(const Json& config) const override;
  [[nodiscard]] std::size_t outputs() const override { return 3; }
  [[nodiscard]] std::vector<double> evaluate(std::span<const double> input, const Json& config) const override;

 private:
  [[nodiscard]] Json spec_in(const Json& config) const;
  [[nodiscard]] StudyState finished(StudyState state) const;

  StudyService& service_;
  std::chrono::seconds patience_;
};

}  // namespace steerstat
