// The stepper's headers lack these two.
#include <boost/numeric/odeint/util/bind.hpp>
#include <boost/numeric/odeint/util/unwrap_reference.hpp>

#include <boost/numeric/odeint/stepper/dense_output_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include <exception>
#include <functional>

#include "guard_watch.hpp"
#include "peer.hpp"

namespace steerstat::bench {
namespace {

namespace odeint = boost::numeric::odeint;

using Dense = odeint::result_of::make_dense_output<odeint::runge_kutta_dopri5<Vector>>::type;

/// The dense output of a step as powers of its fraction: of degree 5, and so known from six of its points.
StepPolynomial dense_polynomial(Dense& stepper, double from, double to) {
  constexpr std::size_t n = 6;
  StepPolynomial step;
  step.start = from;
  step.width = to - from;
  step.order = n - 1;
  std::array<Vector, n> d;  // divided differences in u = 0, 1/5, ... 1
  const auto node = [](std::size_t i) { return static_cast<double>(i) / (n - 1); };
  for (std::size_t i = 0; i < n; ++i) stepper.calc_state(from + node(i) * step.width, d[i]);
  for (std::size_t j = 1; j < n; ++j) {
    for (std::size_t i = n - 1; i >= j; --i) {
      for (std::size_t f = 0; f < 4; ++f) d[i][f] = (d[i][f] - d[i - 1][f]) / (node(i) - node(i - j));
    }
  }
  std::array<Vector, n> c{};  // Horner's scheme for Newton's form
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t f = 0; f < 4; ++f) {
      for (std::size_t k = n - 1; k > 0; --k) c[k][f] = c[k - 1][f] - node(i) * c[k][f];
      c[0][f] = d[i][f] - node(i) * c[0][f];
    }
  }
  for (std::size_t k = 0; k < n; ++k) step.coefficients[k] = state_of(c[k].data());
  return step;
}

class DormandPrince5 final : public Peer {
 public:
  explicit DormandPrince5(double tolerance)
      : stepper_(odeint::make_dense_output(tolerance, tolerance, odeint::runge_kutta_dopri5<Vector>())) {}

  Arrival advance(const ClosedLoop<double>& loop, const Phase& phase, double t0, const State<double>& x0,
                  double t_end) override {
    system_ = {loop, phase};
    const double duration = t_end - t0;
    stepper_.initialize(vector_of(x0), 0.0, 0.1 * first_step(phase));
    Moment before = moment(0.0, vector_of(x0));
    watch_.start(before);
    while (true) {
      try {
        stepper_.do_step(rate_);
      } catch (const std::exception&) {  // 500 shorter steps in a row failed
        return {t0 + before.t, state_of(before.y.data()), Cause::failure};
      }
      const bool last = stepper_.current_time() >= duration;
      const double t = last ? duration : stepper_.current_time();
      const double end_of_step = stepper_.current_time();
      if (!is_finite(stepper_.current_state()) || end_of_step - before.t < least_step) {
        return {t0 + before.t, state_of(before.y.data()), Cause::failure};
      }
      const Moment after = moment(end_of_step, stepper_.current_state());
      const auto suspects = watch_.suspects(before, after);
      if (std::any_of(suspects.begin(), suspects.end(), std::identity{})) {
        const StepPolynomial step = dense_polynomial(stepper_, before.t, end_of_step);
        const auto crossing = watch_.first(step, system_, suspects);
        if (crossing && crossing->t <= duration) return {t0 + crossing->t, at(crossing->t), Cause::guard};
      }
      if (last) return {t_end, at(t), Cause::time};
      before = after;
    }
  }

 private:
  [[nodiscard]] Moment moment(double t, const Vector& y) const {
    Vector rate;
    rate_(y, rate, t);
    return {system_, t, y, rate};
  }
  [[nodiscard]] State<double> at(double t) {
    Vector y;
    stepper_.calc_state(t, y);
    return state_of(y.data());
  }

  struct Rate {
    const ClosedLoopRate* system;
    void operator()(const Vector& y, Vector& dydt, double t) const { (*system)(y.data(), dydt.data(), t); }
  };

  ClosedLoopRate system_;
  Rate rate_{&system_};
  GuardWatch watch_;
  Dense stepper_;
};

}  // namespace

std::unique_ptr<Peer> make_dopri5(double tolerance) {
  return std::make_unique<DormandPrince5>(tolerance);
}

}  // namespace steerstat::bench
