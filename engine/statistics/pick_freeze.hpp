#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "statistics/resampling.hpp"
#include "statistics/sensitivity_interval.hpp"

namespace steerstat {

/// How one input drives an output [Sobol' 1993], [Homma and Saltelli 1996].
struct SobolIndices {
  SensitivityIndex first_order;  ///< share of the output's variance that fixing the input alone would remove
  SensitivityIndex total;        ///< share that would remain if every other input were fixed: interactions included
};

/// Sobol' indices of independent inputs from a pick-freeze design.
///
/// Row r evaluates the output at two independent points, A and B, and at d more, AB_i: A with input i taken from B.
///
///     total        T_i = sum (f(A) - f(AB_i))^2 / 2 N V                              [Jansen 1999]
///     first order  S_i = corr(f(B), f(AB_i)) - (1 - T_i) corr(f(A), f(B))
///
/// V is the variance over A and B. The first term of S_i is the estimator of [Janon 2014], in which the pair's mean and
/// variance are pooled; the second takes out what of it is due to a chance correlation of A and B, as
/// [Glen and Isaacs 2012] do. Measured on the Ishigami and g-functions and on binary outputs (N = 500) its standard
/// error is below both Janon's, which is 1 / sqrt(N) for an input without effect, and that of [Saltelli 2010], which is
/// sqrt(2 T_i / N) for one that only interacts: here it is exactly 0 for the former and 1 / sqrt(N) for the latter.
/// An estimate may leave [0, 1] by its error.
///
/// The intervals resample rows, which must be independent; with a low-discrepancy base they are too wide, not too
/// narrow. Rows past 16,384 are resampled in groups of neighbours. Deterministic; thread-safe.
///
/// @param outputs  (rows x (inputs + 2)) finite, row by row: f(A), f(B), f(AB_1), ..., f(AB_d)
/// @return (inputs); nothing where there are fewer than least_sensitivity_sample rows or the output does not vary
/// @throws std::invalid_argument where `outputs` is no such table
std::optional<std::vector<SobolIndices>> pick_freeze_indices(std::span<const double> outputs, std::size_t inputs,
                                                             const Resampling& resampling);

}  // namespace steerstat
