#pragma once

#include <cmath>
#include <cstdint>

#include "control/goal.hpp"
#include "control/phase.hpp"
#include "core/state.hpp"
#include "trial/trial.hpp"

namespace steerstat {

/// Measures how far each contraction cycle of a trial contracted, phase by phase: the paper's eta1 and eta2 as
/// achieved.
///
/// A cycle counts that ran its whole period: its end is where it ended, before any realignment. The distance to go,
/// e = w - u (CONTROLLER.md section 4), is followed through the cycle, so that it does not jump by a turn where u
/// leaves [0, 2 pi); behind the goal it is negative.
class ContractionRecord {
 public:
  /// A phase starts at t [s] in state x. @param horizon  [s] no phase runs past it
  void start(const Phase& phase, double t, const State<double>& x, const Goal& goal, double horizon) {
    open_ = phase.kind == PhaseKind::contraction && t + phase.duration <= horizon;
    if (!open_) return;
    distance_ = goal.width - modulo_turn(goal.sigma * (x.q2 - goal.edge));
    start_ = x;
  }

  /// The phase came to its end in state x.
  void finish(const State<double>& x, const Goal& goal) {
    if (!open_) return;
    open_ = false;
    const double position = (distance_ - goal.sigma * (x.q2 - start_.q2)) / distance_;
    const double velocity = x.q2_dot / start_.q2_dot;
    if (!std::isfinite(position) || !std::isfinite(velocity)) return;
    ++cycles_;
    position_.add(position);
    velocity_.add(velocity);
  }

  [[nodiscard]] ContractionRatios position() const { return position_.ratios(cycles_); }
  [[nodiscard]] ContractionRatios velocity() const { return velocity_.ratios(cycles_); }

 private:
  struct Ratios {
    double sum{0.0};
    double worst{0.0};

    void add(double ratio) {
      sum += ratio;
      if (std::abs(ratio) >= std::abs(worst)) worst = ratio;
    }
    [[nodiscard]] ContractionRatios ratios(std::uint32_t cycles) const {
      if (cycles == 0) return {};
      return {sum / cycles, worst};
    }
  };

  bool open_{false};  // a contraction cycle that will run its whole period is under way
  double distance_{0.0};
  State<double> start_{};
  std::uint32_t cycles_{0};
  Ratios position_;
  Ratios velocity_;
};

}  // namespace steerstat
