#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include "peer.hpp"
#include "stepped_guards.hpp"

namespace steerstat::bench {
namespace {

namespace odeint = boost::numeric::odeint;

class Fehlberg78 final : public Peer {
 public:
  explicit Fehlberg78(double tolerance) : stepper_(odeint::make_controlled(tolerance, tolerance, Method())) {}

  Arrival advance(const ClosedLoop<double>& loop, const Phase& phase, double t0, const State<double>& x0,
                  double t_end) override {
    system_ = {loop, phase};
    const double duration = t_end - t0;
    Moment before = moment(0.0, vector_of(x0));
    guards_.start(before);
    double step = first_step(phase);
    while (before.t < duration) {
      const bool last = before.t + step >= duration;
      double dt = last ? duration - before.t : step;
      const double tried = dt;
      double t = before.t;
      Vector y;
      const bool failed = stepper_.try_step(rate_, before.y, before.rate, t, y, dt) == odeint::fail;
      if (failed || !is_finite(y)) {
        step = failed ? dt : 0.25 * tried;
        if (!(step >= least_step)) return {t0 + before.t, state_of(before.y.data()), Cause::failure};
        continue;
      }
      if (!last || dt > step) step = dt;
      const Moment after = moment(last ? duration : t, y);
      if (const auto end = guards_.fired(system_, before, after, [&](double to) { return restep(before, to); })) {
        return {t0 + end->t, state_of(end->y.data()), Cause::guard};
      }
      before = after;
    }
    return {t_end, state_of(before.y.data()), Cause::time};
  }

 private:
  using Method = odeint::runge_kutta_fehlberg78<Vector>;

  [[nodiscard]] Moment moment(double t, const Vector& y) const {
    Vector rate;
    rate_(y, rate, t);
    return {system_, t, y, rate};
  }
  [[nodiscard]] Moment restep(const Moment& from, double to) {
    Vector y;
    method_.do_step(rate_, from.y, from.rate, from.t, y, to - from.t);
    return moment(to, y);
  }

  struct Rate {
    const ClosedLoopRate* system;
    void operator()(const Vector& y, Vector& dydt, double t) const { (*system)(y.data(), dydt.data(), t); }
  };

  ClosedLoopRate system_;
  Rate rate_{&system_};
  SteppedGuards guards_;
  odeint::controlled_runge_kutta<Method> stepper_;
  Method method_;
};

}  // namespace

std::unique_ptr<Peer> make_fehlberg78(double tolerance) {
  return std::make_unique<Fehlberg78>(tolerance);
}

std::string peer_flags() {
  return STEERSTAT_PEER_FLAGS;
}

}  // namespace steerstat::bench
