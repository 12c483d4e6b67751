#pragma once

#include <array>
#include <cstddef>

#include "core/polynomial.hpp"
#include "robot/linearised.hpp"

/// The nilpotent approximation of (5) around a regular point (§3.1-3.2), on which the cycle and its contraction
/// formulas rest. Every function needs a regular point where accessibility_determinant() is not zero; elsewhere the
/// results are not finite. All are pure and thread-safe.
namespace steerstat {

/// Privileged coordinates z, zero at the regular point; their orders are 1, 1, 2, 3.
template <class Real>
struct Privileged {
  Real z1{};  ///< [s]
  Real z2{};  ///< [m/s]
  Real z3{};  ///< [m]
  Real z4{};  ///< [m^2/s]
};

/// z = Phi(x), (8).
template <class Real>
Privileged<Real> privileged_coordinates(const RegularPoint<Real>& x0, const State<Real>& x) {
  const Real ks = x0.coupling * x0.s;
  const Real kc = x0.coupling * x0.c;
  const Real two(2.0);
  const Real d1 = x.q1 - x0.q1;
  const Real d2 = x.q2 - x0.q2;
  const Real d3 = x.q1_dot;  // a regular point has q1_dot = 0
  const Real d4 = x.q2_dot - x0.q2_dot;
  const Real y4 = x0.q2_dot * d1 / (two * ks) - d3 / (two * kc) + d4 / (two * kc * ks);
  return {(d2 - ks * d1) / x0.q2_dot, d3, -d1, y4 + (d1 - d2 / ks) * d3 / two};
}

/// x = Phi^-1(z), the inverse of (8).
template <class Real>
State<Real> state_at(const RegularPoint<Real>& x0, const Privileged<Real>& z) {
  const Real ks = x0.coupling * x0.s;
  const Real kc = x0.coupling * x0.c;
  const Real two(2.0);
  const Real d2 = x0.q2_dot * z.z1 - ks * z.z3;
  const Real y4 = z.z4 + x0.q2_dot * z.z1 * z.z2 / (two * ks);
  const Real d4 = ks * z.z2 + kc * x0.q2_dot * z.z3 + two * kc * ks * y4;
  return {x0.q1 - z.z3, x0.q2 + d2, z.z2, x0.q2_dot + d4};
}

/// dz/dt of (5) in privileged coordinates, exactly: dPhi/dx (f + g a), evaluated at x.
///
/// @param x  the state whose coordinates move
/// @param s  sin q2 at x
/// @param a  [m/s^2]
template <class Real>
Privileged<Real> privileged_rates(const RegularPoint<Real>& x0, const State<Real>& x, const Real& s, const Real& a) {
  const Real ks = x0.coupling * x0.s;
  const Real kc = x0.coupling * x0.c;
  const Real two(2.0);
  const State<Real> f = drift_field(x);
  const State<Real> g = input_field(x0.coupling, s);
  const Real r1 = f.q1;
  const Real r2 = f.q2;
  const Real r3 = g.q1_dot * a;
  const Real r4 = g.q2_dot * a;
  const Real y4_rate = x0.q2_dot * r1 / (two * ks) - r3 / (two * kc) + r4 / (two * kc * ks);
  const Real bilinear = (r1 - r2 / ks) * x.q1_dot + ((x.q1 - x0.q1) - (x.q2 - x0.q2) / ks) * r3;
  return {(r2 - ks * r1) / x0.q2_dot, r3, -r1, y4_rate + bilinear / two};
}

/// dz/dt of the nilpotent approximation (9).
///
/// The paper prints -q2_dot / (4 K c) z1^2 in the last component; expanding (8) along g gives q2_dot squared there,
/// which tests/robot/nilpotent_test.cpp confirms. The response at T is the same with either, because the cycle's
/// integrals make this term vanish.
template <class Real>
Privileged<Real> nilpotent_rates(const RegularPoint<Real>& x0, const Privileged<Real>& z, const Real& a) {
  const Real quadratic = x0.q2_dot * x0.q2_dot / (Real(4.0) * x0.coupling * x0.c);
  return {Real(1.0), a, -z.z2, -(quadratic * z.z1 * z.z1 + z.z3 / Real(2.0)) * a};
}

/// An acceleration a(t) = A / T^2 p(t / T) with the integrals that (9) makes of it.
///
/// @tparam N  degree of p, which has no constant term
template <std::size_t N>
class PolynomialCommand {
 public:
  /// @param coefficients  (N) of p in powers from lambda^1 to lambda^N
  constexpr explicit PolynomialCommand(const std::array<double, N>& coefficients)
      : value_(with_constant_term(coefficients)),
        first_(integral(value_)),
        second_(integral(first_)),
        quadratic_(integral(product(std::array<double, 3>{0.0, 0.0, 1.0}, value_))),
        area_(integral(product(second_, value_))) {}

  /// p itself.
  constexpr const auto& value() const { return value_; }
  /// Integral of p: the first joint's velocity.
  constexpr const auto& first() const { return first_; }
  /// Integral of that: the first joint's displacement.
  constexpr const auto& second() const { return second_; }
  /// Integral of lambda^2 p.
  constexpr const auto& quadratic() const { return quadratic_; }
  /// Integral of second() p, at 1 the negative of the integral of first()^2 where the velocity returns to zero.
  constexpr const auto& area() const { return area_; }

 private:
  static constexpr std::array<double, N + 1> with_constant_term(const std::array<double, N>& coefficients) {
    std::array<double, N + 1> p{};
    for (std::size_t k = 0; k < N; ++k) p[k + 1] = coefficients[k];
    return p;
  }

  std::array<double, N + 1> value_;
  std::array<double, N + 2> first_;
  std::array<double, N + 3> second_;
  std::array<double, N + 4> quadratic_;
  std::array<double, 2 * N + 4> area_;
};

/// The state of (9) after `t` of a command, in closed form from z = 0. For the cycle (11) at t = T it is
/// (T, 0, 0, -beta A^2 / T).
///
/// @param amplitude A [m], @param period T [s] > 0, @param t [s] in [0, T]
template <class Real, std::size_t N>
Privileged<Real> nilpotent_response(const RegularPoint<Real>& x0, const PolynomialCommand<N>& command,
                                    const Real& amplitude, const Real& period, const Real& t) {
  const Real lambda = t / period;
  const Real half(0.5);
  const Real quadratic = x0.q2_dot * x0.q2_dot / (Real(4.0) * x0.coupling * x0.c);
  return {t, amplitude / period * evaluate(command.first(), lambda), -amplitude * evaluate(command.second(), lambda),
          half * amplitude * amplitude / period * evaluate(command.area(), lambda) -
              quadratic * amplitude * period * evaluate(command.quadratic(), lambda)};
}

}  // namespace steerstat
