#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "closed_loop_rate.hpp"
#include "integrate/step_polynomial.hpp"

namespace steerstat::bench {

/// A moment of a phase, with its guards.
struct Moment {
  double t{0.0};  ///< [s] since the phase's start
  Vector y{};
  Vector rate{};
  std::array<double, guard_count> guards{};

  Moment() = default;
  Moment(const ClosedLoopRate& system, double time, const Vector& state, const Vector& derivative)
      : t(time), y(state), rate(derivative), guards(steerstat::guards(system.loop, system.phase, state_of(y.data()))) {}

  /// The most that |d guard / dt| can be here.
  [[nodiscard]] double speed_of(std::size_t guard) const {
    if (guard == 0) return std::hypot(rate[0], rate[2]);
    return std::abs(guard == 3 ? rate[3] : rate[1]);
  }
};

/// Which guards of a phase may fire, step by step.
class GuardWatch {
 public:
  void start(const Moment& at) {
    for (std::size_t i = 0; i < guard_count; ++i) {
      used_[i] = at.guards[i] < Phase::unbounded;
      armed_[i] = at.guards[i] > 0.0;
    }
  }

  /// Whether guard i may have fired between two moments: unless both are too far from it for the speeds there.
  [[nodiscard]] bool may_fire(std::size_t i, const Moment& before, const Moment& after) const {
    constexpr double margin = 4.0;  // how much faster than at its ends a guard may move within a step
    if (!used_[i]) return false;
    const double reach = margin * (after.t - before.t) * std::max(before.speed_of(i), after.speed_of(i));
    return !armed_[i] || before.guards[i] <= 0.0 || after.guards[i] <= 0.0 ||
           before.guards[i] + after.guards[i] <= reach;
  }

  struct Crossing {
    double t;
    std::size_t guard;
  };
  /// The first crossing on a polynomial of those guards that `suspects` names; brings up to date which are armed.
  std::optional<Crossing> first(const StepPolynomial& step, const ClosedLoopRate& system,
                                const std::array<bool, guard_count>& suspects) {
    std::optional<Crossing> found;
    for (std::size_t i = 0; i < guard_count; ++i) {
      if (!suspects[i]) continue;
      const std::optional<double> t = first_crossing(step, system.loop, system.phase, i, armed_[i]);
      if (t && (!found || *t < found->t)) found = {*t, i};
    }
    return found;
  }

  [[nodiscard]] std::array<bool, guard_count> suspects(const Moment& before, const Moment& after) const {
    std::array<bool, guard_count> suspects{};
    for (std::size_t i = 0; i < guard_count; ++i) suspects[i] = may_fire(i, before, after);
    return suspects;
  }

 private:
  std::array<bool, guard_count> used_{};
  std::array<bool, guard_count> armed_{};  // the guard has been positive in this phase
};

}  // namespace steerstat::bench
