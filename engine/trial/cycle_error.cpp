#include "trial/cycle_error.hpp"

#include <algorithm>
#include <cmath>

#include "control/cycle.hpp"
#include "core/elementary.hpp"
#include "core/errors.hpp"
#include "robot/nilpotent.hpp"

namespace steerstat {
namespace {

constexpr PolynomialCommand<5> command(cycle_coefficients);

// Within a cycle the error is a smooth function of t with a few extremes.
constexpr int samples_within = 64;

/// Samples the second joint at equal intervals as the integration passes them.
class Sampler final : public StepObserver {
 public:
  Sampler(double period, int samples) : period_(period), samples_(samples) {}

  void step(double /*from*/, double to, const DenseOutput& output) override {
    while (next_ < samples_ && time_of(next_) <= to) {
      states.push_back(output.at(time_of(next_)));
      ++next_;
    }
  }

  [[nodiscard]] double time_of(int sample) const {
    return period_ * static_cast<double>(sample) / static_cast<double>(samples_);
  }

  std::vector<State<double>> states;  // at samples 1, 2, ..., samples - 1

 private:
  double period_;
  int samples_;
  int next_{1};
};

RegularPoint<double> start_of(const Cycle& cycle, double coupling) {
  const auto [s, c] = sincos(cycle.q2);
  return {0.0, cycle.q2, cycle.q2_dot, s, c, coupling};
}

JointError error_of(const CycleComparison::Moment& moment) {
  const double position = std::abs(moment.q2 - moment.approximate_q2);
  const double velocity = std::abs(moment.q2_dot - moment.approximate_q2_dot);
  return {position, velocity, std::sqrt(position * position + velocity * velocity)};
}

}  // namespace

CycleComparison::CycleComparison(const PlantParameters<double>& plant, double tolerance)
    : integrator_(tolerance),
      loop_{constants_of(plant), constants_of(plant), 1.0, 1.0, 0.0},
      coupling_(coupling(plant)) {}

std::vector<CycleComparison::Moment> CycleComparison::course_of(const Cycle& cycle, int samples) {
  Phase phase;
  phase.kind = PhaseKind::contraction;
  phase.amplitude = cycle.amplitude;
  phase.duration = cycle.period;
  const State<double> start{0.0, cycle.q2, 0.0, cycle.q2_dot};
  Sampler sampler(cycle.period, samples);
  const Arrival arrival = integrator_.advance(loop_, phase, 0.0, start, cycle.period, &sampler);
  if (arrival.cause == Cause::failure) throw RunFailure("the integration of a cycle failed; loosen the tolerance");
  std::vector<State<double>> states{start};
  states.insert(states.end(), sampler.states.begin(), sampler.states.end());
  states.push_back(arrival.state);

  const RegularPoint<double> x0 = start_of(cycle, coupling_);
  std::vector<Moment> moments;
  moments.reserve(states.size());
  for (int i = 0; i <= samples; ++i) {
    const double t = i == samples ? cycle.period : sampler.time_of(i);
    const State<double> approximate = state_at(x0, nilpotent_response(x0, command, cycle.amplitude, cycle.period, t));
    const State<double>& real = states.at(static_cast<std::size_t>(i));
    moments.push_back({t, real.q2, real.q2_dot, approximate.q2, approximate.q2_dot});
  }
  return moments;
}

CycleError CycleComparison::error_of(const Cycle& cycle) {
  const std::vector<Moment> moments = course_of(cycle, samples_within);
  CycleError result{steerstat::error_of(moments.back()), {}, 0.0, 0.0};
  for (const Moment& moment : moments) {
    const JointError error = steerstat::error_of(moment);
    result.worst.position = std::max(result.worst.position, error.position);
    result.worst.velocity = std::max(result.worst.velocity, error.velocity);
    result.worst.state = std::max(result.worst.state, error.state);
  }
  result.position_step = result.end.position / std::abs(cycle.q2_dot * cycle.period);  // (12)
  const auto [s, c] = sincos(cycle.q2);
  const double promised =
      -2.0 * coupling_ * coupling_ * c * s * beta * cycle.amplitude * cycle.amplitude / cycle.period;  // (13)
  result.velocity_step = result.end.velocity / std::abs(promised);
  return result;
}

}  // namespace steerstat
