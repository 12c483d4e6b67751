#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "guard_watch.hpp"

namespace steerstat::bench {

/// The motion between two moments: both positions as quintics through position, velocity and acceleration at both ends,
/// the velocities as their derivatives.
inline StepPolynomial hermite(const Moment& before, const Moment& after) {
  StepPolynomial step;
  step.start = before.t;
  step.width = after.t - before.t;
  step.order = 5;
  const double h = step.width;
  const auto joint = [&](std::size_t i, double State<double>::*position, double State<double>::*velocity) {
    const double p0 = before.y[i], v0 = h * before.y[i + 2], a0 = h * h * before.rate[i + 2];
    const double d = after.y[i] - p0, v1 = h * after.y[i + 2], a1 = h * h * after.rate[i + 2];
    const std::array<double, 6> c{p0,
                                  v0,
                                  0.5 * a0,
                                  10.0 * d - 6.0 * v0 - 4.0 * v1 - 1.5 * a0 + 0.5 * a1,
                                  -15.0 * d + 8.0 * v0 + 7.0 * v1 + 1.5 * a0 - a1,
                                  6.0 * d - 3.0 * (v0 + v1) + 0.5 * (a1 - a0)};
    for (std::size_t k = 0; k < 6; ++k) {
      step.coefficients[k].*position = c[k];
      if (k > 0) step.coefficients[k - 1].*velocity = static_cast<double>(k) * c[k] / h;
    }
  };
  joint(0, &State<double>::q1, &State<double>::q1_dot);
  joint(1, &State<double>::q2, &State<double>::q2_dot);
  return step;
}

/// Finds guards for a method without dense output worth the name: a crossing is first sought on a quintic, or on two
/// where a dip has to be found or excluded, and then located by steps of the method itself from the step's start.
class SteppedGuards {
 public:
  void start(const Moment& at) { watch_.start(at); }

  /// The moment in (before, after] at which a guard fires first.
  ///
  /// @param restep  double t -> Moment, one step of the method from `before` to t
  template <class Restep>
  std::optional<Moment> fired(const ClosedLoopRate& system, const Moment& before, const Moment& after,
                              Restep&& restep) {
    const std::array<bool, guard_count> suspects = watch_.suspects(before, after);
    if (std::none_of(suspects.begin(), suspects.end(), std::identity{})) return std::nullopt;
    const bool plain = std::any_of(after.guards.begin(), after.guards.end(), [](double g) { return g <= 0.0; });
    if (plain) return search(system, before, after, suspects, restep);
    const Moment middle = restep(0.5 * (before.t + after.t));
    if (auto found = search(system, before, middle, suspects, restep)) return found;
    return search(system, middle, after, suspects, restep);
  }

 private:
  template <class Restep>
  std::optional<Moment> search(const ClosedLoopRate& system, const Moment& from, const Moment& to,
                               const std::array<bool, guard_count>& suspects, Restep& restep) {
    const auto crossing = watch_.first(hermite(from, to), system, suspects);
    if (!crossing) return std::nullopt;
    return refine(system, from, to, *crossing, restep);
  }

  /// Newton's method on the method's own steps. Nothing where the quintic showed a crossing that is none.
  template <class Restep>
  std::optional<Moment> refine(const ClosedLoopRate& system, const Moment& from, const Moment& to,
                               GuardWatch::Crossing crossing, Restep& restep) {
    constexpr double close = 1e-7;  // [s] what remains after a change this small is its square
    double t = crossing.t;
    for (int i = 0; i < 12; ++i) {
      Moment at = restep(t);
      const double change = -at.guards[crossing.guard] / guard_rate(system, at, crossing.guard);
      if (std::abs(change) < close) {
        for (std::size_t k = 0; k < at.y.size(); ++k) at.y[k] += change * at.rate[k];
        at.t += change;
        return at;
      }
      const double next = std::clamp(t + change, from.t, to.t);
      if (!(next != t)) break;
      t = next;
    }
    return std::nullopt;
  }

  static double guard_rate(const ClosedLoopRate& system, const Moment& at, std::size_t guard) {
    switch (guard) {
      case 0: {
        const double e = at.y[0] - system.loop.q1_goal;
        return (e * at.rate[0] + at.y[2] * at.rate[2]) / std::hypot(e, at.y[2]);
      }
      case 1:
        return at.rate[1];
      case 2:
        return -at.rate[1];
      default:
        return system.phase.direction * at.rate[3];
    }
  }

  GuardWatch watch_;
};

}  // namespace steerstat::bench
