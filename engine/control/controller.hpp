#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

namespace steerstat {

/// Whose rules choose the phases.
enum class Policy : std::uint8_t {
  paper = 0,   ///< the paper's strategy: CONTROLLER.md section 5
  robust = 1,  ///< the rules of README.md beside this file
};

inline constexpr std::array<std::string_view, 2> policy_names{"paper", "robust"};

constexpr std::string_view name_of(Policy policy) {
  return policy_names[static_cast<std::size_t>(policy)];
}

/// When the first joint is realigned before deciding (§5).
enum class Realignment : std::uint8_t {
  never = 0,        ///< only on convergence: the paper's frictionless run
  after_cycle = 1,  ///< after every cycle, contraction or swing: the paper's run with friction
  always = 2,       ///< after every drift too
};

inline constexpr std::array<std::string_view, 3> realignment_names{"never", "after_cycle", "always"};

/// Parameters of the controller (CONTROLLER.md section 6); the defaults are its column "default". Those of the robust
/// policy are in README.md beside this file.
struct Controller {
  struct Alignment {
    double kp{7.0};          ///< [1/s^2]
    double kd{5.0};          ///< [1/s]
    double tolerance{1e-3};  ///< bound on the active error, norm of m and m/s
    /// [s] robust policy: an align that friction keeps from its tolerance ends after this
    double max_duration{3.5};
    friend bool operator==(const Alignment&, const Alignment&) = default;
  };
  struct Drift {
    double min_speed{0.0};  ///< [rad/s] slower drifts are sped up by a swing wherever a swing can; 0 is the paper
    friend bool operator==(const Drift&, const Drift&) = default;
  };
  struct Swing {
    double period{2.0};           ///< [s]
    double speed{0.2};            ///< [rad/s] wanted after the swing
    double max_amplitude{200.0};  ///< [m]
    double min_authority{0.4};    ///< least |sin 2 q2| at which a swing is worth its while, < 0.9
    friend bool operator==(const Swing&, const Swing&) = default;
  };
  struct Contraction {
    double eta1{0.5};         ///< contraction rate of the position, in (0, 1)
    double eta2{0.6};         ///< contraction rate of the velocity, in (0, 1)
    double max_period{30.0};  ///< [s] a longer cycle means a stalled joint
    friend bool operator==(const Contraction&, const Contraction&) = default;
  };
  struct Convergence {
    double tolerance{0.005};        ///< on the passive error, rad + rad/s
    double active_tolerance{0.02};  ///< on the active error
    friend bool operator==(const Convergence&, const Convergence&) = default;
  };

  /// What the robust policy alone reads.
  struct Robust {
    double rate{0.4};               ///< [1/s] r, the ratio of speed to distance along which both shrink
    double period{1.8};             ///< [s] T of a cycle, where the joint is not too fast for it
    double alignment_time{1.2};     ///< [s] tau, how long the align after a cycle is expected to last
    double travel_speed{0.25};      ///< [rad/s] V, wanted between the wells
    double entry_fraction{0.3};     ///< where in the goal's quadrant braking may begin, in (0, 1)
    double turning_angle{0.6};      ///< [rad] b, how far from a well's middle the joint turns back
    double max_acceleration{19.0};  ///< [m/s^2] bound on the |a| that is asked of the first joint
    friend bool operator==(const Robust&, const Robust&) = default;
  };

  Policy policy{Policy::paper};
  Alignment alignment{};
  Realignment realignment{Realignment::after_cycle};
  double entry_fraction{0.5};  ///< where in the goal's quadrant contraction may begin, in (0, 1)
  Drift drift{};
  double rest_speed{1e-3};  ///< [rad/s] slower is at rest
  Swing swing{};
  Contraction contraction{};
  Convergence convergence{};
  Robust robust{};

  double max_stroke{std::numeric_limits<double>::infinity()};  ///< [m] a trial whose |q1 - q1_goal| exceeds it fails
  double horizon{300.0};                                       ///< [s] no phase runs past it
  double coupling{0.4};  ///< [1/m] K of (4) with the nominal plant, what the controller believes

  friend bool operator==(const Controller&, const Controller&) = default;
};

}  // namespace steerstat
