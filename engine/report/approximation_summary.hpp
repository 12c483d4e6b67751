#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "statistics/sample.hpp"
#include "statistics/sample_interval.hpp"
#include "study/approximation.hpp"

namespace steerstat {

/// One way to measure the error of the nilpotent approximation in a cycle.
struct ErrorMeasure {
  std::string_view name;
  std::string_view unit;
  double (*value)(const CycleError&);
};

inline constexpr std::size_t error_measure_count = 8;

/// Every measure, in the order that summaries list them.
std::span<const ErrorMeasure, error_measure_count> error_measures();

/// An order, the exponent of a power law: fitted to each draw's errors by least squares in logarithms.
struct FittedOrder {
  std::uint64_t draws{0};                ///< whose errors are all positive
  double mean{0.0};                      ///< over the draws
  std::optional<double> standard_error;  ///< of the mean; draws are independent
  SampleInterval interval;               ///< of the mean, Student's t at approximation_level
  double p05{0.0}, p50{0.0}, p95{0.0};   ///< of the draws
};

/// Level of the orders' intervals.
inline constexpr double approximation_level = 0.95;

/// What an approximation study found.
struct ApproximationSummary {
  std::string name, engine_version;
  std::uint64_t seed{0};
  double coupling{0.0};    ///< K [1/m]
  double tolerance{0.0};   ///< of the integration
  std::uint64_t draws{0};  ///< a cell
  struct Cell {
    std::array<std::optional<double>, 4> sweep;  ///< by CycleInput, nothing where it is not swept
    std::array<SampleStatistics, error_measure_count> errors;
  };
  std::vector<Cell> cells;
  /// How a measure grows; nothing where the input has no two different sizes among its swept values.
  struct Orders {
    std::optional<FittedOrder> amplitude;  ///< error ~ |A|^p at fixed T
    std::optional<FittedOrder> period;     ///< error ~ T^p at fixed A
    std::optional<FittedOrder> dilation;   ///< error ~ T^p along A ~ T^2, the same acceleration for a longer time
  };
  std::array<Orders, error_measure_count> orders;
};

/// Summarises the errors of an approximation study's cycles. @param errors  run_approximation() of the study
ApproximationSummary summarise(const ApproximationStudy& study, std::span<const CycleError> errors);

/// The summary as JSON (schemas/approximation_summary.schema.json), indented, ending in a newline.
std::string approximation_json(const ApproximationSummary& summary);

/// The summary as text for a terminal: UTF-8, about 100 columns, ending in a newline.
///
/// @param colour  use ANSI colours
std::string approximation_text(const ApproximationSummary& summary, bool colour);

}  // namespace steerstat
