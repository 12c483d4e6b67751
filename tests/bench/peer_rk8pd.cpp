#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include "peer.hpp"
#include "stepped_guards.hpp"

namespace steerstat::bench {
namespace {

template <auto free>
struct Free {
  template <class T>
  void operator()(T* object) const {
    free(object);
  }
};

int right_hand_side(double t, const double* y, double* dydt, void* system) {
  (*static_cast<const ClosedLoopRate*>(system))(y, dydt, t);
  return GSL_SUCCESS;
}

class Rk8pd final : public Peer {
 public:
  explicit Rk8pd(double tolerance)
      : step_(gsl_odeiv2_step_alloc(gsl_odeiv2_step_rk8pd, 4)),
        restep_(gsl_odeiv2_step_alloc(gsl_odeiv2_step_rk8pd, 4)),
        control_(gsl_odeiv2_control_y_new(tolerance, tolerance)),
        evolve_(gsl_odeiv2_evolve_alloc(4)) {
    gsl_set_error_handler_off();  // its return codes say enough; the default is to abort
  }

  Arrival advance(const ClosedLoop<double>& loop, const Phase& phase, double t0, const State<double>& x0,
                  double t_end) override {
    rate_ = {loop, phase};
    const double duration = t_end - t0;
    gsl_odeiv2_step_reset(step_.get());
    gsl_odeiv2_evolve_reset(evolve_.get());
    Moment before = moment(0.0, vector_of(x0));
    guards_.start(before);
    double h = first_step(phase);
    Vector y = before.y;
    while (before.t < duration) {
      double t = before.t;
      const int code =
          gsl_odeiv2_evolve_apply(evolve_.get(), control_.get(), step_.get(), &system_, &t, duration, &h, y.data());
      if (code != GSL_SUCCESS || !is_finite(y) || (t - before.t < least_step && t < duration)) {
        return {t0 + before.t, state_of(before.y.data()), Cause::failure};
      }
      const Moment after(rate_, t, y,
                         {evolve_->dydt_out[0], evolve_->dydt_out[1], evolve_->dydt_out[2], evolve_->dydt_out[3]});
      if (const auto end = guards_.fired(rate_, before, after, [&](double to) { return restep(before, to); })) {
        return {t0 + end->t, state_of(end->y.data()), Cause::guard};
      }
      before = after;
    }
    return {t_end, state_of(before.y.data()), Cause::time};
  }

 private:
  [[nodiscard]] Moment moment(double t, const Vector& y) const {
    Vector rate;
    rate_(y.data(), rate.data(), t);
    return {rate_, t, y, rate};
  }
  [[nodiscard]] Moment restep(const Moment& from, double to) {
    Vector y = from.y;
    Vector error;
    gsl_odeiv2_step_apply(restep_.get(), from.t, to - from.t, y.data(), error.data(), from.rate.data(), nullptr,
                          &system_);
    return moment(to, y);
  }

  ClosedLoopRate rate_;
  gsl_odeiv2_system system_{right_hand_side, nullptr, 4, &rate_};
  SteppedGuards guards_;
  std::unique_ptr<gsl_odeiv2_step, Free<gsl_odeiv2_step_free>> step_;
  std::unique_ptr<gsl_odeiv2_step, Free<gsl_odeiv2_step_free>> restep_;
  std::unique_ptr<gsl_odeiv2_control, Free<gsl_odeiv2_control_free>> control_;
  std::unique_ptr<gsl_odeiv2_evolve, Free<gsl_odeiv2_evolve_free>> evolve_;
};

}  // namespace

std::unique_ptr<Peer> make_rk8pd(double tolerance) {
  return std::make_unique<Rk8pd>(tolerance);
}

}  // namespace steerstat::bench
