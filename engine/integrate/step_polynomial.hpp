#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "control/phase.hpp"
#include "core/state.hpp"
#include "integrate/closed_loop.hpp"
#include "integrate/descent.hpp"

namespace steerstat {

/// The dense output of one step, as powers of the fraction u of the step, from 0 at its start to 1 at its end.
struct StepPolynomial {
  static constexpr std::size_t highest_order = highest_degree / 2;

  double start{0.0};  ///< [s]
  double width{0.0};  ///< [s]
  std::size_t order{0};
  std::array<State<double>, highest_order + 1> coefficients{};  ///< (order + 1 used), lowest power first
};

/// Where in a step `guard` fires, at its first crossing.
///
/// @param guard  index into guards(); its bound is finite
/// @param armed  whether it has been positive in this phase; brought up to date
/// @return the time [s]; nothing where it does not fire
std::optional<double> first_crossing(const StepPolynomial& step, const ClosedLoop<double>& loop, const Phase& phase,
                                     std::size_t guard, bool& armed);

}  // namespace steerstat
