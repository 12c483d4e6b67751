#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/study.hpp"

namespace steerstat {

/// The empirical distribution function of a metric, in few enough points to draw.
struct EmpiricalDistribution {
  std::string metric;
  std::string unit;
  std::uint64_t trials{0};  ///< that have the metric
  std::vector<double> x;    ///< rising
  std::vector<double> f;    ///< share of the trials at or below each x
  struct Band {
    double level;
    double half_width;  ///< see distribution_band()
  };
  std::optional<Band> band;
  std::string band_note;  ///< why there is none; "" where there is one
};

/// An empirical distribution has at most this many points.
inline constexpr std::size_t most_distribution_points = 400;

/// Why a band about a distribution function over a study's trials would not hold; "" where it does: the trials must be
/// independent draws, of a number that nobody decided by looking at them.
/// @param cells  of the study
std::string obstacle_to_band(const Study& study, std::uint64_t cells);

/// @param values    finite, in any order
/// @param obstacle  obstacle_to_band()
/// @param level     of the band
EmpiricalDistribution empirical_distribution(std::string metric, std::string unit, std::vector<double> values,
                                             const std::string& obstacle, double level);

}  // namespace steerstat
