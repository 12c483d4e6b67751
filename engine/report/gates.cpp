#include "report/gates.hpp"

#include <algorithm>
#include <cmath>

#include "statistics/confidence_sequence.hpp"
#include "statistics/sample_interval.hpp"
#include "study/rate.hpp"
#include "trial/metric.hpp"

namespace steerstat {
namespace {

using Samples = std::vector<std::vector<double>>;  // (cells, or one) x the values of the trials that have the metric

/// The probability of a quantile; nothing for another quantity.
std::optional<double> probability_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::p05:
      return 0.05;
    case Quantity::p50:
      return 0.5;
    case Quantity::p95:
      return 0.95;
    case Quantity::p99:
      return 0.99;
    default:
      return std::nullopt;
  }
}

double value_of(const SampleStatistics& sample, Quantity quantity) {
  switch (quantity) {
    case Quantity::min:
      return sample.min;
    case Quantity::p05:
      return sample.p05;
    case Quantity::p50:
      return sample.p50;
    case Quantity::p95:
      return sample.p95;
    case Quantity::p99:
      return sample.p99;
    case Quantity::max:
      return sample.max;
    default:
      return sample.mean;
  }
}

Evidence rate_evidence(Status outcome, Quantity quantity, const TrialStatistics& statistics,
                       const IntervalChoice& intervals) {
  if (quantity == Quantity::count) return {static_cast<double>(statistics.completed), {}};
  if (statistics.completed == 0) return {};
  const ProportionInterval rate = proportion_interval(
      intervals.method, statistics.outcomes[static_cast<std::size_t>(outcome)], statistics.completed, intervals.level);
  const double value = quantity == Quantity::ci_low    ? rate.low
                       : quantity == Quantity::ci_high ? rate.high
                                                       : rate.estimate;
  return {value, {rate.low, rate.high}};
}

/// @param values  of the metric, in any order; only a quantile needs them
Evidence sample_evidence(const std::optional<SampleStatistics>& sample, Quantity quantity, std::vector<double> values,
                         const IntervalChoice& intervals) {
  if (quantity == Quantity::count) return {sample ? static_cast<double>(sample->count) : 0.0, {}};
  if (!sample) return {};
  Evidence evidence{value_of(*sample, quantity), {}};
  if (quantity == Quantity::mean) {
    evidence.interval = mean_interval(sample->mean, sample->std, sample->count, intervals.level);
  } else if (const auto p = probability_of(quantity)) {
    std::sort(values.begin(), values.end());
    // Where the study may be looked at again and again, so must a quantile's interval hold.
    evidence.interval = intervals.method == ProportionMethod::confidence_sequence
                            ? quantile_confidence_sequence(values, *p, intervals.level)
                            : quantile_interval(values, *p, intervals.level);
  }
  return evidence;
}

/// The values that a gate's quantile is of; empty where it asks for none.
Samples samples_for(const Gate& gate, bool by_cell, const Plan& plan, const TrialTable& trials) {
  Samples samples(by_cell ? plan.cells() : 1);
  const Metric* metric = find_metric(gate.metric);
  if (metric == nullptr || !probability_of(gate.expression.quantity)) return samples;
  for (std::size_t row = 0; row < trials.index.size(); ++row) {
    if (!plan.is_independent(trials.index[row])) continue;  // as in the rest of the summary
    const double value = metric->value(trials.outcomes[row]);
    if (!std::isnan(value)) samples[by_cell ? plan.cell_of(trials.index[row]) : 0].push_back(value);
  }
  return samples;
}

bool is_in(const std::vector<Plan::SweptValue>& cell, const std::vector<Gate::SweptValue>& choice) {
  return std::all_of(choice.begin(), choice.end(), [&](const Gate::SweptValue& chosen) {
    return std::any_of(cell.begin(), cell.end(), [&](const Plan::SweptValue& swept) {
      return swept.name == chosen.input && swept.value == chosen.value;
    });
  });
}

GateVerdict verdict_on(const Gate& gate, const TrialStatistics& statistics, std::vector<double> values,
                       const IntervalChoice& intervals, std::string_view shortfall) {
  const auto outcome = outcome_of_rate(gate.metric);
  const Quantity quantity = gate.expression.quantity;
  const Evidence evidence = outcome
                                ? rate_evidence(*outcome, quantity, statistics, intervals)
                                : sample_evidence(statistics.of(gate.metric), quantity, std::move(values), intervals);
  auto [verdict, reason] = judge(gate.expression, evidence, shortfall);
  return {gate.metric,      expression_text(gate.expression), {}, evidence.value, evidence.interval, verdict,
          std::move(reason)};
}

}  // namespace

std::vector<GateVerdict> judge_gates(const Study& study, const Plan& plan, const TrialTable& trials,
                                     const Summary& summary) {
  const std::string shortfall = shortfall_of(summary);
  std::vector<GateVerdict> verdicts;
  for (const Gate& gate : study.gates) {
    const bool by_cell = (gate.each_cell || !gate.cell.empty()) && !summary.cells.empty();
    Samples samples = samples_for(gate, by_cell, plan, trials);
    if (!by_cell) {
      verdicts.push_back(verdict_on(gate, summary.all, std::move(samples.front()), summary.intervals, shortfall));
      continue;
    }
    for (std::size_t i = 0; i < summary.cells.size(); ++i) {
      const Summary::Cell& cell = summary.cells[i];
      if (!is_in(cell.sweep, gate.cell)) continue;
      verdicts.push_back(verdict_on(gate, cell.statistics, std::move(samples[i]), summary.intervals, shortfall));
      verdicts.back().cell = cell.sweep;
    }
  }
  return verdicts;
}

}  // namespace steerstat
