#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "study/study.hpp"
#include "view/viewed_study.hpp"

namespace steerstat {

/// How trials are put into bins by the values of one input: by its levels where it is swept, discrete or listed and has
/// few, else by bins of equal width.
struct Axis {
  std::string input;  ///< dotted name
  std::string unit;
  std::vector<double> edges;   ///< (bins + 1) rising: bin k is [edge k, edge k + 1), the last one closed; or none
  std::vector<double> levels;  ///< (bins) rising; or none

  [[nodiscard]] std::size_t bins() const { return levels.empty() ? edges.size() - 1 : levels.size(); }

  /// @return nothing for a value beyond the edges, or that is no level
  [[nodiscard]] std::optional<std::size_t> bin_of(double value) const;
};

/// An input with more levels than this gets bins of equal width.
inline constexpr std::size_t most_levels = 48;

/// The axis of an input over its values in the trials that count. It spans them all where the input has bounds, and
/// else what lies between their 0.1 % and 99.9 % quantiles, so that a long tail does not press the rest together.
///
/// @param input   as the study's inputs have it; of a listed one its value is ignored
/// @param listed  whether explicit trials set it
/// @param values  (trials) of the trials that count, not empty, finite
/// @param bins    of equal width, where it gets those, > 0
Axis axis_of(const Input& input, bool listed, std::span<const double> values, std::size_t bins);

/// How many trials lie in each bin of an axis, or of a plane of two, and how many of them converged.
struct BinCounts {
  std::vector<std::uint64_t> trials;     ///< (bins), or (bins of y x bins of x)
  std::vector<std::uint64_t> successes;  ///< of them
  std::uint64_t outside{0};              ///< trials beyond the axes
};

/// Where a value of bin_numbers() that is in no bin stands.
inline constexpr std::uint16_t outside_axis = 0xFFFF;

/// @return (values) the bin of each, or outside_axis
std::vector<std::uint16_t> bin_numbers(const Axis& axis, std::span<const double> values);

/// @param bins       how many there are
/// @param bin        (trials) the bin of each, or outside_axis
/// @param converged  (trials) 1 or 0
BinCounts count_bins(std::size_t bins, std::span<const std::uint16_t> bin, std::span<const std::uint8_t> converged);

/// The same over a plane: bin (i, j), i along x, stands at j * x_bins + i.
BinCounts count_bins(std::size_t x_bins, std::span<const std::uint16_t> x, std::size_t y_bins,
                     std::span<const std::uint16_t> y, std::span<const std::uint8_t> converged);

}  // namespace steerstat
