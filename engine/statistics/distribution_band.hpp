#pragma once

#include <cstdint>

namespace steerstat {

/// Half the width of the band about the empirical distribution function of n independent values in which the whole true
/// distribution function lies with at least probability `level`: sqrt(ln(2 / (1 - level)) / (2 n)), at every n and
/// whatever the distribution [Dvoretzky et al. 1956], with the constant of [Massart 1990], which cannot be bettered.
///
/// @param n      > 0
/// @param level  in (0, 1)
/// @throws std::invalid_argument outside those ranges
double distribution_band(std::uint64_t n, double level);

}  // namespace steerstat
