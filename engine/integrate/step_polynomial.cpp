#include "integrate/step_polynomial.hpp"

#include <span>

namespace steerstat {
namespace {

using Coefficients = std::array<double, highest_degree + 1>;

/// scale * field + offset, as a polynomial. @return its number of coefficients
std::size_t linear_guard(const StepPolynomial& step, double State<double>::*field, double scale, double offset,
                         Coefficients& p) {
  for (std::size_t k = 0; k <= step.order; ++k) p[k] = scale * (step.coefficients[k].*field);
  p[0] += offset;
  return step.order + 1;
}

/// The sum over powers i and k of term(i, k), and offset. @return its number of coefficients
template <class Term>
std::size_t quadratic_guard(const StepPolynomial& step, const Term& term, double offset, Coefficients& p) {
  p.fill(0.0);
  for (std::size_t i = 0; i <= step.order; ++i) {
    for (std::size_t k = 0; k <= step.order; ++k) p[i + k] += term(i, k);
  }
  p[0] += offset;
  return 2 * step.order + 1;
}

/// (q1 - q1_goal)^2 + q1_dot^2 - tolerance^2 of what is read, which has the signs of the active error's guard.
std::size_t active_guard(const StepPolynomial& step, double q1_goal, const Phase& phase, Coefficients& p) {
  const auto error = [&](std::size_t k) {
    const double q1 = step.coefficients[k].q1;
    return k == 0 ? q1 + phase.q1_offset - q1_goal : q1;
  };
  const auto velocity = [&](std::size_t k) {
    return step.coefficients[k].q1_dot + (k == 0 ? phase.q1_dot_offset : 0.0);
  };
  const auto squares = [&](std::size_t i, std::size_t k) { return error(i) * error(k) + velocity(i) * velocity(k); };
  return quadratic_guard(step, squares, -(phase.active_tolerance * phase.active_tolerance), p);
}

/// ceiling^2 - a^2, which has the signs of the guard of |a|.
std::size_t ceiling_guard(const StepPolynomial& step, const ClosedLoop<double>& loop, const Phase& phase,
                          Coefficients& p) {
  const AlignGains<double> gains = align_gains(loop, phase);
  const auto a = [&](std::size_t k) {
    const State<double>& x = step.coefficients[k];
    return k == 0 ? align_acceleration(loop, phase, x) : -(gains.kp * x.q1 + gains.kd * x.q1_dot);
  };
  const auto square = [&](std::size_t i, std::size_t k) { return -(a(i) * a(k)); };
  return quadratic_guard(step, square, phase.ceiling * phase.ceiling, p);
}

std::size_t guard_polynomial(const StepPolynomial& step, const ClosedLoop<double>& loop, const Phase& phase,
                             std::size_t guard, Coefficients& p) {
  switch (guard) {
    case 0:
      return active_guard(step, loop.q1_goal, phase, p);
    case 1:
      return linear_guard(step, &State<double>::q2, 1.0, -phase.q2_low, p);
    case 2:
      return linear_guard(step, &State<double>::q2, -1.0, phase.q2_high, p);
    case 3:
      return linear_guard(step, &State<double>::q2_dot, phase.direction, -phase.speed_floor, p);
    default:
      return ceiling_guard(step, loop, phase, p);
  }
}

}  // namespace

std::optional<double> first_crossing(const StepPolynomial& step, const ClosedLoop<double>& loop, const Phase& phase,
                                     std::size_t guard, bool& armed) {
  Coefficients p;
  const std::size_t size = guard_polynomial(step, loop, phase, guard, p);
  const std::optional<double> fraction = first_descent(std::span(p).first(size), armed);
  if (!fraction) return std::nullopt;
  return step.start + *fraction * step.width;
}

}  // namespace steerstat
