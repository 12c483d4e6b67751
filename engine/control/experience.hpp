#pragma once

#include <cstdint>

namespace steerstat {

/// What the robust policy has learned of a trial's true plant, and the leg of its course that it will learn from next.
struct Experience {
  /// What a leg is: a drift, or a cycle with the align that follows it.
  enum class Leg : std::uint8_t { none, drift, cycle };

  double gain{1.0};      ///< what a cycle changes the passive joint's speed by, true over nominal
  double friction{0.0};  ///< [1/s] speed that the passive joint loses per radian travelled

  Leg leg{Leg::none};     ///< under way, or just ended
  double q2{0.0};         ///< [rad] where it started
  double q2_dot{0.0};     ///< [rad/s] there
  double period{0.0};     ///< [s] of its cycle
  double amplitude{0.0};  ///< [m] of its cycle

  friend bool operator==(const Experience&, const Experience&) = default;
};

}  // namespace steerstat
