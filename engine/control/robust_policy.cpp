#include "control/robust_policy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "control/cycle.hpp"
#include "core/elementary.hpp"
#include "core/function_clones.hpp"

namespace steerstat {
namespace {

constexpr double pi = std::numbers::pi;

// The rules' own constants; README.md says what each is for.
constexpr double arrived = 1e-6;          // [rad] a drift that ended at an angle is there
constexpr double most_turn = 1.0;         // [rad] a quick joint turns in a cycle
constexpr double least_period = 0.5;      // [s] of the cycle of a quick joint
constexpr double most_stretch = 1.05;     // of the period of a cycle that the bound on |a| keeps too weak
constexpr double spare_authority = 0.1;   // beyond min_authority, where the dead zones' edges are
constexpr double least_drift = 0.1;       // [rad] that friction is learned from
constexpr double most_friction = 0.5;     // [1/s]
constexpr double least_push = 0.02;       // [rad/s] that the gain is learned from
constexpr double least_gain = 0.4;        // of a cycle
constexpr double most_gain = 2.0;         // of a cycle
constexpr double patience = 10.0;         // [s] the time that a joint may need for what lies before it
constexpr double creeping_speed = 0.003;  // [rad/s]
constexpr double creeping_range = 0.05;   // [rad] beyond the goal
constexpr double quick_enough = 0.7;      // share of the wanted speed with which the joint travels on
constexpr double arrival_speed = 0.03;    // [rad/s] expected, where the joint coasts against the push
constexpr double least_sine = 1e-3;       // |sin 2 q2| that a cycle's amplitude allows for

double nominal_gain(const Controller& controller) {
  return controller.coupling * controller.coupling * beta;
}

/// sin 2 y, y the passive joint past the goal's edge.
double double_sine(double y) {
  const SinCos<double> angle = sincos(y);
  return 2.0 * angle.sin * angle.cos;
}

/// y of README.md section 1, in [-pi/2, 3 pi/2).
double angle_past_edge(double q2, const Goal& goal) {
  const double u = modulo_turn(goal.sigma * (q2 - goal.edge));
  return u < 1.5 * pi ? u : u - 2.0 * pi;
}

/// [s] of the next cycle, with the joint at a speed omega.
double cycle_period(double omega, const Controller::Robust& robust) {
  return std::min(robust.period, std::max(least_period, most_turn / std::abs(omega)));
}

/// [rad/s] what a cycle of period T that brakes from omega, at a distance e, is to leave of the speed.
double speed_after_braking(double omega, double e, double T, const Controller::Robust& robust) {
  const double tau = robust.alignment_time, r = robust.rate;
  return std::max(0.1 * omega, r * (e - 0.5 * T * omega) / (1.0 + r * (0.5 * T + tau)));
}

/// The rules in one state; README.md section 1 has the symbols.
class RobustPolicy {
 public:
  RobustPolicy(const State<double>& x, const Experience& experience, const Controller& controller, const Goal& goal)
      : controller_(controller),
        robust_(controller.robust),
        goal_(goal),
        q1_offset_(std::abs(x.q1 - goal.q1)),
        q2_(x.q2),
        gain_(experience.gain),
        c_(experience.friction),
        y_(angle_past_edge(x.q2, goal)),
        omega_(goal.sigma * x.q2_dot),
        e_(goal.width - y_),
        s2_(double_sine(y_)),
        home_(y_ < 0.5 * pi),
        z_(home_ ? y_ : y_ - pi),
        d_(s2_ > 0.0 ? -1.0 : 1.0),
        v_(d_ * omega_),
        entry_(robust_.entry_fraction * goal.width),
        delta_(0.5 * arc_sine(controller.swing.min_authority + spare_authority)),
        near_(std::max(0.0, 0.9 * controller.convergence.tolerance - std::abs(omega_))),
        period_(cycle_period(omega_, robust_)),
        travel_(travel()) {}

  [[nodiscard]] Phase choose() const {
    if (const auto phase = brake()) return *phase;
    if (const auto phase = approach()) return *phase;
    if (const auto phase = creep_back()) return *phase;
    if (const auto phase = coast_with_push()) return *phase;
    if (const auto phase = coast_against_push()) return *phase;
    if (const auto phase = push()) return *phase;
    if (const auto phase = leave_dead_zone()) return *phase;
    return cycle(PhaseKind::swing, travel_.speed - v_, y_);
  }

 private:
  /// Where a joint that goes with the push shall go, and how fast it has to start to arrive as it should.
  struct Travel {
    double speed;     // [rad/s] along the push
    double distance;  // [rad] signed, in y
  };

  [[nodiscard]] Travel travel() const {
    const double over = 0.5 * pi + delta_;
    if (!home_) return {robust_.travel_speed + c_ * (std::abs(z_) + over), d_ * over - z_};
    if (d_ > 0.0) {
      const double speed = std::min(robust_.travel_speed, robust_.rate * (goal_.width - entry_));
      return {speed + c_ * (entry_ - y_), entry_ - y_};
    }
    return {robust_.travel_speed + c_ * (y_ + robust_.turning_angle), -robust_.turning_angle - y_};
  }

  [[nodiscard]] bool approaches() const { return 0.0 < y_ && y_ < goal_.width && omega_ > 0.0; }

  /// Rule 1: too fast for the distance left: to the ratio omega/e = r with one cycle.
  [[nodiscard]] std::optional<Phase> brake() const {
    if (!approaches() || y_ < entry_ - arrived || omega_ < braking_share * robust_.rate * e_) return std::nullopt;
    const double T = period_;
    const double after = speed_after_braking(omega_, e_, T, robust_);
    const double distance = 0.5 * T * (omega_ + after) + robust_.alignment_time * after;
    return cycle(PhaseKind::contraction, omega_ - after - c_ * distance, y_ + T * (3.0 * omega_ + after) / 8.0);
  }

  /// Rule 2: slow enough to drift, fast enough to arrive: until the ratio is r.
  [[nodiscard]] std::optional<Phase> approach() const {
    if (!approaches()) return std::nullopt;
    const double left = std::max(0.0, e_ - near_);
    if (omega_ <= c_ * left || patience * omega_ <= left) return std::nullopt;
    const double r = robust_.rate;
    const double target = std::min(std::max((omega_ - c_ * e_) / std::max(0.01, r - c_), near_), goal_.width - entry_);
    if (e_ - target <= arrived) return std::nullopt;
    return drift(e_ - target, left / 20.0);
  }

  /// Rule 3: a little beyond the goal.
  [[nodiscard]] std::optional<Phase> creep_back() const {
    const double wanted = creeping_speed + c_ * std::abs(e_);
    if (e_ < -creeping_range || e_ > 0.0 || v_ > 1.6 * creeping_speed) return std::nullopt;
    if (v_ < 0.5 * wanted) return cycle(PhaseKind::swing, wanted - v_, y_);
    if (std::abs(e_) <= near_ + 1e-7) return std::nullopt;
    return drift(e_ + near_, 0.25 * wanted);
  }

  /// Rule 4: fast enough in the push's direction: to where the next push or the brake waits.
  [[nodiscard]] std::optional<Phase> coast_with_push() const {
    if (v_ < quick_enough * travel_.speed || std::abs(travel_.distance) <= 1e-9) return std::nullopt;
    return drift(travel_.distance, 0.5 * std::abs(omega_));
  }

  /// Rule 5: against the push's direction, only where friction lets the joint arrive.
  [[nodiscard]] std::optional<Phase> coast_against_push() const {
    if (v_ >= 0.0) return std::nullopt;
    const auto arrives = [&](double distance) { return std::abs(omega_) - c_ * std::abs(distance) >= arrival_speed; };
    const double over = 0.5 * pi + delta_, b = robust_.turning_angle;
    if (const double onward = -d_ * over - z_; !home_ && arrives(onward)) return drift(onward, 0.5 * std::abs(omega_));
    if (home_ && d_ < 0.0) return std::nullopt;
    if (std::abs(z_) < b - arrived) {
      if (!arrives(b - std::abs(z_))) return std::nullopt;
      return drift(-d_ * b - z_, 0.5 * std::abs(omega_));
    }
    // Reversing takes more than one cycle can do: less of it, and with more authority, a little further on.
    const bool too_much = travel_.speed - v_ > strongest_push(y_);
    if (!too_much || v_ >= -arrival_speed || std::abs(z_) >= 0.25 * pi - arrived) return std::nullopt;
    return drift(-d_ * 0.25 * pi - z_, 0.5 * std::abs(omega_));
  }

  /// Rule 6: where a cycle has authority, and keeps it as the joint turns.
  [[nodiscard]] std::optional<Phase> push() const {
    if (std::abs(s2_) < controller_.swing.min_authority) return std::nullopt;
    const double mean = y_ + period_ * (3.0 * omega_ + d_ * travel_.speed) / 8.0;
    if (double_sine(mean) * s2_ <= 0.0) return std::nullopt;
    return cycle(PhaseKind::swing, travel_.speed - v_, mean);
  }

  /// Rule 7: where no cycle has authority: as the joint turns, on to the zone's edge.
  [[nodiscard]] std::optional<Phase> leave_dead_zone() const {
    constexpr double quarter = 0.5 * pi;
    const double to_axis = std::abs(y_ - quarter * std::nearbyint(y_ / quarter));
    if (omega_ == 0.0 || patience * std::abs(omega_) < to_axis) return std::nullopt;
    const double along = omega_ > 0.0 ? 1.0 : -1.0;
    const double place = along * y_ - quarter * std::floor(along * y_ / quarter);  // in [0, pi/2)
    double distance = patience * std::abs(omega_);
    for (const double edge : {delta_, quarter - delta_, quarter + delta_}) {
      if (edge - place <= arrived) continue;
      distance = std::min(distance, edge - place);
      break;
    }
    return drift(along * distance, 0.5 * std::abs(omega_));
  }

  /// A drift until the joint has turned by `distance` [rad, in y], or slowed down to `floor` [rad/s].
  [[nodiscard]] Phase drift(double distance, double floor) const {
    const double turn = goal_.sigma * distance;  // in q2
    Phase phase;
    phase.kind = PhaseKind::drift;
    (turn > 0.0 ? phase.q2_high : phase.q2_low) = q2_ + turn;
    phase.direction = turn > 0.0 ? 1.0 : -1.0;
    phase.speed_floor = floor;
    return phase;
  }

  /// [rad/s] what a cycle can change the speed by, with the joint about y.
  [[nodiscard]] double strongest_push(double mean) const {
    const double A = robust_.max_acceleration * period_ * period_ / cycle_peak;
    return gain_ * nominal_gain(controller_) * std::abs(double_sine(mean)) * (A * A) / period_;
  }

  /// A cycle that pushes the joint by b [rad/s], as far as the bounds on |a| and on the stroke allow; no push where
  /// b <= 0.
  ///
  /// @param mean  [rad] y that the joint is about while the cycle pushes
  [[nodiscard]] Phase cycle(PhaseKind kind, double b, double mean) const {
    const double strongest = strongest_push(mean);
    const double T = period_ * (b > strongest ? std::min(most_stretch, std::sqrt(b / strongest)) : 1.0);
    const double push = gain_ * nominal_gain(controller_) * std::max(least_sine, std::abs(double_sine(mean)));
    const double by_acceleration = robust_.max_acceleration * T * T / cycle_peak;
    const double by_stroke = std::max(0.0, controller_.max_stroke - q1_offset_) / cycle_excursion;
    Phase phase;
    phase.kind = kind;
    phase.duration = T;
    phase.amplitude = std::min({by_acceleration, by_stroke, std::sqrt(T * std::max(b, 0.0) / push)});
    return phase;
  }

  const Controller& controller_;
  const Controller::Robust& robust_;
  const Goal& goal_;
  double q1_offset_;
  double q2_;
  double gain_;
  double c_;
  double y_;
  double omega_;
  double e_;
  double s2_;
  bool home_;
  double z_;
  double d_;
  double v_;
  double entry_;   // y_e
  double delta_;   // half the width of a dead zone
  double near_;    // so close to the goal the joint has arrived
  double period_;  // of the next cycle
  Travel travel_;
};

}  // namespace

STEERSTAT_CLONED
void learn(const State<double>& x, const Controller& controller, const Goal& goal, Experience& experience) {
  const double turned = goal.sigma * (x.q2 - experience.q2);
  const double sped_up = goal.sigma * (x.q2_dot - experience.q2_dot);
  if (experience.leg == Experience::Leg::drift && std::abs(turned) >= least_drift) {
    experience.friction = std::clamp(-sped_up / turned, 0.0, most_friction);
  } else if (experience.leg == Experience::Leg::cycle) {
    const double T = experience.period, A = experience.amplitude;
    const double mean = goal.sigma * (experience.q2 - goal.edge + T * (3.0 * experience.q2_dot + x.q2_dot) / 8.0);
    const double nominal = nominal_gain(controller) * double_sine(mean) * (A * A) / T;
    if (std::abs(nominal) >= least_push) {
      experience.gain = std::clamp(-(sped_up + experience.friction * turned) / nominal, least_gain, most_gain);
    }
  }
  experience.leg = Experience::Leg::none;
}

void embark(const Phase& phase, const State<double>& x, Experience& experience) {
  if (phase.kind == PhaseKind::align) return;
  experience.leg = phase.kind == PhaseKind::drift ? Experience::Leg::drift : Experience::Leg::cycle;
  experience.q2 = x.q2;
  experience.q2_dot = x.q2_dot;
  experience.period = phase.duration;
  experience.amplitude = phase.amplitude;
}

BrakingAim braking_aim(const State<double>& x, const Controller& controller, const Goal& goal) {
  const double omega = goal.sigma * x.q2_dot;
  const double e = goal.width - angle_past_edge(x.q2, goal);
  const double T = cycle_period(omega, controller.robust);
  const double after = speed_after_braking(omega, e, T, controller.robust);
  const double left = e - 0.5 * T * (omega + after);
  return {left, left - controller.robust.alignment_time * after, after};
}

STEERSTAT_CLONED
Phase steer_robustly(const State<double>& x, const Experience& experience, const Controller& controller,
                     const Goal& goal) {
  return RobustPolicy(x, experience, controller, goal).choose();
}

}  // namespace steerstat
