#pragma once

#include <cstdint>

#include "core/state.hpp"

namespace steerstat {

/// What the supervisor reads of the state, less the state (engine/robot/README.md); exact by default.
struct Sensor {
  State<double> bias{};         ///< in the state's units
  State<double> noise{};        ///< standard deviations, in the state's units, >= 0
  std::uint64_t noise_seed{0};  ///< keys the noise of the trial's readings

  /// Whether every reading is the state itself.
  [[nodiscard]] bool is_exact() const { return bias == State<double>{} && noise == State<double>{}; }

  /// The error of reading k = 0, 1, ...: the bias, and of each number an independent normal draw that is a pure
  /// function of (noise_seed, the number's name, k). The same bits on every machine and thread.
  [[nodiscard]] State<double> error(std::uint64_t k) const;

  friend bool operator==(const Sensor&, const Sensor&) = default;
};

/// What a sensor with this error reads in state x.
inline State<double> reading(const State<double>& x, const State<double>& error) {
  return {x.q1 + error.q1, x.q2 + error.q2, x.q1_dot + error.q1_dot, x.q2_dot + error.q2_dot};
}

}  // namespace steerstat
