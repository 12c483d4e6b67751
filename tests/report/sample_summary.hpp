#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "report/summary.hpp"

/// Summaries made up for the tests.
namespace steerstat::testing_report {

/// Statistics of so many trials of each outcome, the converged ones settling at 10 s, 20 s, ... after 1, 2, ... cycles.
inline TrialStatistics made_up_statistics(std::array<std::uint64_t, status_names.size()> outcomes) {
  TrialStatistics statistics;
  statistics.outcomes = outcomes;
  for (const std::uint64_t count : outcomes) statistics.completed += count;
  if (statistics.completed > 0) {
    statistics.success_rate = wilson_interval(outcomes[0], statistics.completed, 0.95);
  }
  statistics.effective_trials = static_cast<double>(statistics.completed);
  std::vector<double> times;
  std::vector<double> cycles;
  for (std::uint64_t i = 1; i <= outcomes[0]; ++i) {
    times.push_back(10.0 * static_cast<double>(i));
    cycles.push_back(static_cast<double>(i));
  }
  statistics.metrics[metric_index("settling_time")] = describe(times);
  statistics.metrics[metric_index("cycles")] = describe(cycles);
  std::vector<double> ratios;
  for (const double time : times) ratios.push_back(1e-4 * time);
  std::vector<double> efforts;
  for (std::uint64_t i = 1; i <= statistics.completed; ++i) efforts.push_back(0.5 * static_cast<double>(i));
  for (const char* metric : {"effort", "peak_acceleration", "peak_force", "peak_stroke"}) {
    statistics.metrics[metric_index(metric)] = describe(efforts);
  }
  for (const char* metric : {"position_contraction_mean", "velocity_contraction_worst"}) {
    statistics.metrics[metric_index(metric)] = describe(ratios);
  }
  return statistics;
}

/// A finished study without sweeps.
inline Summary made_up_summary(std::array<std::uint64_t, status_names.size()> outcomes) {
  Summary summary;
  summary.id = "0123456789abcdef";
  summary.name = "sample";
  summary.spec_sha256 = std::string(64, 'a');
  summary.population_sha256 = std::string(64, 'b');
  summary.engine_version = "0.1.0";
  summary.seed = 7;
  summary.complete = true;
  summary.all = made_up_statistics(outcomes);
  summary.requested = summary.all.completed;
  summary.completed = summary.all.completed;
  summary.wall_s = 4.0;
  summary.threads = 2;
  summary.simd = InstructionSet::avx512;
  return summary;
}

/// A study of cells in which 0, 1, 2, ... of ten trials converge.
inline Summary made_up_sweep(std::uint64_t cells) {
  std::array<std::uint64_t, status_names.size()> outcomes{};
  std::vector<Summary::Cell> list;
  for (std::uint64_t cell = 0; cell < cells; ++cell) {
    const std::uint64_t converged = cell % 11;
    list.push_back({{{"controller.contraction.eta1", 0.001 * static_cast<double>(cell)}},
                    made_up_statistics({converged, 10 - converged, 0, 0, 0})});
    outcomes[0] += converged;
    outcomes[1] += 10 - converged;
  }
  Summary summary = made_up_summary(outcomes);
  summary.cells = std::move(list);
  return summary;
}

}  // namespace steerstat::testing_report
