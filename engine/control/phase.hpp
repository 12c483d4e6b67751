#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

namespace steerstat {

/// What a phase of a trial is for. The numbers are stored in result files; never renumber them.
enum class PhaseKind : std::uint8_t {
  align = 0,        ///< the PD law (10)
  drift = 1,        ///< a = 0 (cases T1-T3 of §4.2)
  contraction = 2,  ///< a cycle (11) with (16)-(17)
  swing = 3,        ///< a cycle (11) that changes the passive joint's speed (case T3)
};

inline constexpr std::array<std::string_view, 4> phase_names{"align", "drift", "contraction", "swing"};

constexpr std::string_view name_of(PhaseKind kind) {
  return phase_names[static_cast<std::size_t>(kind)];
}

/// One phase: which law sets a, and what ends it.
///
/// A phase ends at its duration, at the horizon, or at the first guard to fire. A guard fires once, when its function
/// goes from positive to <= 0 on (t0, t1]; one that is already non-positive at the start waits until it has been
/// positive. The unused guards' bounds are infinite.
struct Phase {
  static constexpr double unbounded = std::numeric_limits<double>::infinity();

  PhaseKind kind{PhaseKind::align};
  double duration{unbounded};      ///< [s] longest it lasts; a cycle's period T
  double pace{1.0};                ///< align: how much quicker than (10) it is; kp takes its square, kd itself
  double amplitude{0.0};           ///< [m] A of (11), cycles only
  double active_tolerance{-1.0};   ///< align: guard active_error - this; negative: no such guard
  double ceiling{unbounded};       ///< [m/s^2] align, beside active_tolerance: guard this - |a|
  double q2_low{-unbounded};       ///< [rad] drift: guard q2 - q2_low
  double q2_high{unbounded};       ///< [rad] drift: guard q2_high - q2
  double direction{1.0};           ///< +1 or -1: the sign of q2_dot that the speed guard watches
  double speed_floor{-unbounded};  ///< [rad/s] drift: guard direction * q2_dot - speed_floor
  double q1_offset{0.0};           ///< [m] align: what its law and its guard read of q1, less the truth
  double q1_dot_offset{0.0};       ///< [m/s] align: the same of q1_dot

  friend bool operator==(const Phase&, const Phase&) = default;
};

}  // namespace steerstat
