#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/instruction_set.hpp"
#include "core/status.hpp"
#include "report/rare_failures.hpp"
#include "report/sensitivity.hpp"
#include "report/verdict.hpp"
#include "statistics/proportion.hpp"
#include "statistics/proportion_drop.hpp"
#include "statistics/sample.hpp"
#include "study/precision_watch.hpp"
#include "study/run.hpp"
#include "study/study.hpp"
#include "trial/metric.hpp"

namespace steerstat {

/// What an interval counts as independent: trials, draws with their trials in all cells, or nothing, where it bears no
/// level (see Independence).
enum class IntervalUnit : std::uint8_t { trial, draw, none };
inline constexpr std::array<std::string_view, 3> interval_unit_names{"trial", "draw", "none"};

/// What a set of trials says; statistics without data are empty. Of a study of Sobol' indices only the trials A and B
/// of each row count, which are independent: the others repeat their values, and intervals would be too narrow. Of a
/// study that seeks failures there are no metrics: its trials are not those of its distributions.
struct TrialStatistics {
  std::uint64_t completed{0};  ///< trials that the statistics are of
  std::optional<ProportionInterval> success_rate;
  IntervalUnit unit{IntervalUnit::trial};  ///< of the intervals
  double effective_trials{0.0};            ///< independent trials that tell as much of the success rate
  std::array<std::uint64_t, status_names.size()> outcomes{};            ///< by Status
  std::array<std::optional<SampleStatistics>, metric_count> metrics{};  ///< in the order of metrics()

  /// @param metric  name of a metric @throws std::invalid_argument where there is none of that name
  [[nodiscard]] const std::optional<SampleStatistics>& of(std::string_view metric) const {
    return metrics[metric_index(metric)];
  }
};

/// How far the reference integrator bears a run out.
struct AuditStatistics {
  std::uint64_t trials{0};              ///< computed again, > 0
  std::uint64_t agree{0};               ///< of them: the same status, cycles and swings
  std::vector<std::uint64_t> disagree;  ///< indices of the others
  struct Difference {
    double median, p99, max;
  };
  std::optional<Difference> settling_time_difference;  ///< [s] absolute, of the converged trials that agree
  double tolerance{0.0};                               ///< of the reference integrator
};

/// How the success rate compares with that of an earlier summary.
struct BaselineComparison {
  std::string id, name, engine_version;  ///< of the baseline
  std::uint64_t seed{0};
  ProportionCount converged{};  ///< of all cells
  BaselineTest test{};
  std::optional<ProportionDrop> drop;  ///< from the baseline to here; nothing without trials, nor where there are cells
  std::optional<double> detectable_drop;  ///< the least that this many trials show with the test's power
  struct Cell {
    std::vector<Plan::SweptValue> sweep;
    ProportionCount converged{};
    std::optional<ProportionDrop> drop;  ///< its lower limit at the test's level over the number of cells
    std::optional<double> detectable_drop;
  };
  std::vector<Cell> cells;  ///< in the order of the summary's
};

/// A study's statistics, as schemas/summary.schema.json describes them.
struct Summary {
  std::string id, name, spec_sha256, population_sha256, engine_version;
  std::uint64_t seed{0};
  bool complete{false};
  std::uint64_t requested{0};
  std::uint64_t completed{0};  ///< finished trials, all of them
  IntervalChoice intervals;
  TrialStatistics all;
  struct Cell {
    std::vector<Plan::SweptValue> sweep;
    TrialStatistics statistics;
  };
  std::vector<Cell> cells;  ///< one a cell where there are sweeps
  struct Stop {
    StopRule rule;
    StopReport report;
  };
  std::optional<Stop> stop;                     ///< where the study has a rule
  std::optional<SobolSensitivity> sensitivity;  ///< of sobol_indices sampling
  std::optional<RareFailures> rare_failures;    ///< of sampling that seeks failures
  std::vector<GateVerdict> gates;               ///< in the spec's order, the baseline's last
  std::optional<BaselineComparison> baseline;   ///< where the run was held against one
  std::optional<AuditStatistics> audit;         ///< nothing where no trial was audited
  double wall_s{0.0};
  unsigned threads{0};
  std::optional<InstructionSet> simd;  ///< what lockstep ran on
  std::optional<StudyShare> share;     ///< where the trials are a share of the study
  Store store{Store::all};             ///< but for all rows, the statistics are those of sketches
};

/// Summarises finished trials. The same trials give the same bits, in whatever order and on however many threads they
/// ran; `wall_s` and `threads` are the run's own.
Summary summarise(const Study& study, const StudyResult& result);

/// What a summary's study is short of, "only 20 of 100 trials have finished"; "" where it is whole.
std::string shortfall_of(const Summary& summary);

/// The summary as JSON (schemas/summary.schema.json), indented, ending in a newline. Every key is always there;
/// statistics without data are null.
std::string summary_json(const Summary& summary);

/// The summary as text for a terminal: UTF-8, about 100 columns, ending in a newline. Of many cells the best and the
/// worst are shown.
///
/// @param colour  use ANSI colours
std::string summary_text(const Summary& summary, bool colour);

}  // namespace steerstat
