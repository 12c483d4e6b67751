#include "trial/replay.hpp"

#include <algorithm>
#include <cmath>

#include "core/elementary.hpp"
#include "core/errors.hpp"
#include "integrate/cvode_integrator.hpp"
#include "integrate/lockstep_integrator.hpp"
#include "trial/check_in_interval.hpp"
#include "trial/course.hpp"

namespace steerstat {
namespace {

/// Takes the samples of one phase.
class PhaseSampler final : public StepObserver {
 public:
  PhaseSampler(const ClosedLoop<double>& loop, const Phase& phase, double start, double interval,
               std::vector<TrajectorySample>& samples, const std::function<void()>& check_in)
      : loop_(loop),
        phase_(phase),
        start_(start),
        interval_(interval),
        next_(std::floor(start / interval) + 1.0),
        samples_(samples),
        check_in_(check_in) {}

  void take(double t, const State<double>& x) {
    const double a = commanded_acceleration(loop_, phase_, t - start_, x);
    const auto [s, c] = sincos(x.q2);
    const double tau = driving_force(loop_, a, x, s, c);
    samples_.push_back({t, x, a, tau, phase_.kind});
  }

  /// Takes the multiples of the interval in [from, to), so that a phase's end is taken once, as its end.
  void step(double, double to, const DenseOutput& output) override {
    if (check_in_interval_.ends_with_step() && check_in_) check_in_();
    for (; next_ * interval_ < to; next_ += 1.0) {
      if (next_ * interval_ > start_) take(next_ * interval_, output.at(next_ * interval_));
    }
  }

 private:
  const ClosedLoop<double>& loop_;
  const Phase& phase_;
  double start_;
  double interval_;
  double next_;  // the next sample, in intervals
  std::vector<TrajectorySample>& samples_;
  const std::function<void()>& check_in_;
  CheckInInterval check_in_interval_{};
};

template <class Integrator>
Trajectory record(const TrialParameters& parameters, Integrator integrator, bool metrics, double interval,
                  int per_cycle, const std::function<void()>& check_in) {
  const ClosedLoop<double> loop = closed_loop_of(parameters);
  Exertion exertion = exertion_at(parameters.start, parameters.goal.q1);
  Exertion* measured = metrics ? &exertion : nullptr;
  Trajectory trajectory;
  trajectory.outcome =
      run_course(parameters, exertion, [&](const Phase& phase, double t, const State<double>& x, double t_end) {
        if (check_in) check_in();
        const std::size_t first = trajectory.samples.size();
        const double longest = per_cycle > 0 ? phase.duration / per_cycle : interval;
        PhaseSampler sampler(loop, phase, t, std::min(interval, longest), trajectory.samples, check_in);
        sampler.take(t, x);
        const Arrival arrival = integrator.advance(loop, phase, t, x, t_end, &sampler, measured);
        sampler.take(arrival.t, arrival.state);
        const bool cut =
            arrival.cause == Cause::failure || (arrival.cause == Cause::time && t + phase.duration > t_end);
        trajectory.phases.push_back({phase.kind, first, trajectory.samples.size() - 1, !cut});
        return arrival;
      });
  if (metrics) report_exertion(exertion, trajectory.outcome);
  return trajectory;
}

}  // namespace

Trajectory replay(const TrialParameters& parameters, const IntegratorChoice& choice, double interval, int per_cycle,
                  const std::function<void()>& check_in) {
  if (!(interval > 0.0)) throw BadUsage("the sampling interval must be positive");
  switch (choice.method) {
    case IntegratorChoice::Method::cvode:
      return record(parameters, CvodeIntegrator(choice.tolerance), choice.metrics, interval, per_cycle, check_in);
    case IntegratorChoice::Method::lockstep:
      return record(parameters,
                    LockstepIntegrator(choice.tolerance, best_instruction_set(), 0, loop_kind_of(parameters)),
                    choice.metrics, interval, per_cycle, check_in);
  }
  throw RunFailure("unknown integration method");
}

bool bears_out(const TrialOutcome& now, const TrialOutcome& then) {
  TrialOutcome known = then;
  const auto fill = [](double& value, double other) {
    if (std::isnan(value)) value = other;
  };
  fill(known.effort, now.effort);
  fill(known.peak_acceleration, now.peak_acceleration);
  fill(known.peak_force, now.peak_force);
  fill(known.peak_stroke, now.peak_stroke);
  fill(known.position_contraction.mean, now.position_contraction.mean);
  fill(known.position_contraction.worst, now.position_contraction.worst);
  fill(known.velocity_contraction.mean, now.velocity_contraction.mean);
  fill(known.velocity_contraction.worst, now.velocity_contraction.worst);
  return same_bits(now, known);
}

}  // namespace steerstat
