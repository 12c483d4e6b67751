#pragma once

#include <chrono>

#include "umbridge/model.hpp"

namespace steerstat {

/// The model `trial`: one closed-loop trial of a robot that is not what the controller believes.
///
/// Input: how far the inputs that `config.inputs` names (plant.m1, plant.m2, plant.f1 and plant.f2 unless given) are
/// from what `config.spec` says (a study spec without distributions or sweeps; `{}` unless given). A plant value other
/// than zero is multiplied by 1 + x; to any other value, as friction that the nominal plant has none of, x is added, in
/// the value's unit. All zeros are the trial of the spec itself.
///
/// Output: [1 where it converged, else 0; settling time [s], the horizon where it did not converge; contraction
/// cycles].
class TrialModel final : public Model {
 public:
  /// @param longest_horizon  [s] that a trial may have
  /// @param patience         how long an evaluation may take
  TrialModel(double longest_horizon, std::chrono::milliseconds patience)
      : longest_horizon_(longest_horizon), patience_(patience) {}

  [[nodiscard]] std::string_view name() const override { return "trial"; }
  [[nodiscard]] std::size_t inputs(const Json& config) const override;
  [[nodiscard]] std::size_t outputs() const override { return 3; }
  [[nodiscard]] std::vector<double> evaluate(std::span<const double> input, const Json& config) const override;

 private:
  double longest_horizon_;
  std::chrono::milliseconds patience_;
};

}  // namespace steerstat
