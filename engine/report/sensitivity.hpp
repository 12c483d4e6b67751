#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "statistics/pick_freeze.hpp"
#include "statistics/sensitivity_interval.hpp"
#include "study/plan.hpp"
#include "study/run.hpp"
#include "trial/metric.hpp"

/// Which uncertain input drives what becomes of the trials.
namespace steerstat {

/// Outputs that indices can be of: success (1 or 0) and end_time, which every trial has, and every metric.
/// @return nothing where there is none of that name
std::optional<Metric> find_output(std::string_view name);

/// Names of all outputs.
std::vector<std::string_view> output_names();

/// Sobol' indices of a study whose sampling is sobol_indices.
struct SobolSensitivity {
  struct Output {
    std::string name;
    std::uint64_t rows{0};                             ///< of which every trial has the output
    std::optional<std::vector<SobolIndices>> indices;  ///< (inputs); nothing of few rows or a constant
  };
  double level{0.95};                   ///< of the intervals: the study's
  std::uint64_t independent_trials{0};  ///< finished trials that are A or B of their row: the summary's statistics
  std::vector<std::string> inputs;
  std::vector<Output> outputs;  ///< success, settling_time, end_time
};

/// @return nothing where the sampling is another
std::optional<SobolSensitivity> sobol_sensitivity(const Study& study, const Plan& plan, const TrialTable& trials);

/// First-order indices from the finished trials of any study: see GivenData. Trials of one draw in several cells are
/// resampled together; of sobol_indices only A and B of each row are used, which are independent; a complete grid has
/// exact indices.
struct GivenDataSensitivity {
  struct Output {
    std::string name;
    std::uint64_t trials{0};                               ///< that have the output
    std::vector<std::optional<SensitivityIndex>> indices;  ///< (inputs); nothing of few trials or a constant
  };
  double level{0.95};               ///< of the intervals: the study's
  bool exact{false};                ///< of a full factorial: without sampling error
  std::vector<std::string> inputs;  ///< all that vary
  std::vector<Output> outputs;
};

/// @param parameters  (varying x trials) the inputs' values
/// @param outputs     at least one
GivenDataSensitivity given_data_sensitivity(const Study& study, const StudyResult& result,
                                            std::span<const std::vector<double>> parameters,
                                            std::span<const Metric> outputs);

/// What `show --sensitivity` shows.
struct SensitivityReport {
  std::string id, name;
  bool complete{false};
  GivenDataSensitivity given_data;
  std::optional<SobolSensitivity> sobol;
};

/// The report as JSON (schemas/sensitivity.schema.json), indented, ending in a newline.
std::string sensitivity_json(const SensitivityReport& report);

/// The report as text for a terminal, inputs by falling index. @param colour  use ANSI colours
std::string sensitivity_text(const SensitivityReport& report, bool colour);

/// Tables of Sobol' indices, inputs by falling total index.
std::string sobol_text(const SobolSensitivity& sobol, bool colour);

}  // namespace steerstat
