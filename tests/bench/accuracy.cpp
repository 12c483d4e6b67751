#include "accuracy.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace steerstat::bench {

Accuracy accuracy_of(std::span<const TrialOutcome> outcomes, std::span<const TrialOutcome> reference) {
  Accuracy accuracy;
  std::vector<double> errors;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const TrialOutcome& a = outcomes[i];
    const TrialOutcome& b = reference[i];
    ++accuracy.trials;
    if (a.status != b.status || a.cycles != b.cycles || a.swings != b.swings || a.alignments != b.alignments) continue;
    ++accuracy.agreeing;
    if (a.status == Status::converged) errors.push_back(std::abs(a.end_time - b.end_time));
  }
  accuracy.settling_error = errors.empty() ? std::numeric_limits<double>::infinity() : median(errors);
  return accuracy;
}

Calibrated calibrate(const std::function<MakeRunner(double tolerance)>& method, std::span<const TrialOutcome> reference,
                     double wanted) {
  const auto at = [&](double exponent) {
    const double tolerance = std::pow(10.0, exponent);
    const Run run = run_trials(reference.size(), method(tolerance));
    return Calibrated{tolerance, accuracy_of(run.outcomes, reference)};
  };
  // Seven steps from a range that holds every method's answer; a method that has none ends at the fine end.
  double fine = -13.0;
  double coarse = -6.0;
  Calibrated best{};
  while (coarse - fine > 0.1) {
    const double middle = 0.5 * (fine + coarse);
    const Calibrated tried = at(middle);
    if (tried.accuracy.settling_error <= wanted) {
      fine = middle;
      best = tried;
    } else {
      coarse = middle;
    }
  }
  return best.tolerance > 0.0 ? best : at(fine);
}

}  // namespace steerstat::bench
