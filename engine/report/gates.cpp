#include "report/gates.hpp"

#include <algorithm>
#include <cmath>

#include "report/independence.hpp"
#include "study/rate.hpp"
#include "trial/metric.hpp"

namespace steerstat {
namespace {

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

/// What a gate is judged by.
struct Question {
  const Gate& gate;
  const Independence& independence;
  bool in_cell;  ///< or over all cells
};

Evidence rate_evidence(Status outcome, const Question& question, const TrialStatistics& statistics) {
  const Quantity quantity = question.gate.expression.quantity;
  if (quantity == Quantity::count) return {static_cast<double>(statistics.completed), {}};
  const auto rate = question.independence.rate(outcome, statistics, question.in_cell);
  if (!rate) return {};
  const double value = quantity == Quantity::ci_low    ? rate->low
                       : quantity == Quantity::ci_high ? rate->high
                                                       : rate->estimate;
  return {value, {rate->low, rate->high}, question.independence.doubt()};
}

/// The values that a quantile is of, whichever way there are any.
struct Values {
  std::vector<double> listed;             ///< in any order
  const QuantileSketch* sketch{nullptr};  ///< where they are not listed
};

SampleInterval quantile_interval_of(const Question& question, const Metric& metric, Values values, double p) {
  if (values.sketch != nullptr) {
    const SketchedOrder order(*values.sketch);
    return order.between(question.independence.quantile_ranks_of_trials(order.size(), p));
  }
  std::sort(values.listed.begin(), values.listed.end());
  return question.independence.quantile(metric, values.listed, p, question.in_cell);
}

/// @param values  of the metric; only a quantile needs them
Evidence sample_evidence(const Question& question, const TrialStatistics& statistics, Values values) {
  const Metric& metric = *find_metric(question.gate.metric);
  const std::optional<SampleStatistics>& sample = statistics.of(metric.name);
  const Quantity quantity = question.gate.expression.quantity;
  if (quantity == Quantity::count) return {sample ? static_cast<double>(sample->count) : 0.0, {}};
  if (!sample) return {};
  Evidence evidence{value_of(*sample, quantity), {}, question.independence.doubt()};
  if (quantity == Quantity::mean) {
    evidence.interval = question.independence.mean(metric, *sample, question.in_cell);
  } else if (const auto p = probability_of(quantity)) {
    evidence.interval = quantile_interval_of(question, metric, std::move(values), *p);
  }
  return evidence;
}

/// The values that a gate's quantile is of, (cells, or one); empty where it asks for none.
std::vector<Values> values_for(const Gate& gate, bool by_cell, const Plan& plan, const StudyResult& result) {
  std::vector<Values> values(by_cell ? plan.cells() : 1);
  const Metric* metric = find_metric(gate.metric);
  if (metric == nullptr || !probability_of(gate.expression.quantity)) return values;
  if (result.sketch) {
    // Over several cells no gate asks a sketch for a quantile (check_store()).
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i].sketch = &result.sketch->cells()[i].metrics[metric_index(gate.metric)].quantiles;
    }
    return values;
  }
  const TrialTable& trials = result.trials;
  for (std::size_t row = 0; row < trials.index.size(); ++row) {
    if (!plan.is_independent(trials.index[row])) continue;  // as in the rest of the summary
    const double value = metric->value(trials.outcomes[row]);
    if (!std::isnan(value)) values[by_cell ? plan.cell_of(trials.index[row]) : 0].listed.push_back(value);
  }
  return values;
}

bool is_in(const std::vector<Plan::SweptValue>& cell, const std::vector<Gate::SweptValue>& choice) {
  return std::all_of(choice.begin(), choice.end(), [&](const Gate::SweptValue& chosen) {
    return std::any_of(cell.begin(), cell.end(), [&](const Plan::SweptValue& swept) {
      return swept.name == chosen.input && swept.value == chosen.value;
    });
  });
}

GateVerdict verdict_on(const Question& question, const TrialStatistics& statistics, Values values,
                       std::string_view shortfall) {
  const Gate& gate = question.gate;
  const auto outcome = outcome_of_rate(gate.metric);
  const Evidence evidence = outcome ? rate_evidence(*outcome, question, statistics)
                                    : sample_evidence(question, statistics, std::move(values));
  auto [verdict, reason] = judge(gate.expression, evidence, shortfall);
  return {gate.metric,      expression_text(gate.expression), {}, evidence.value, evidence.interval, verdict,
          std::move(reason)};
}

}  // namespace

std::vector<GateVerdict> judge_gates(const Study& study, const Plan& plan, const StudyResult& result,
                                     const Summary& summary) {
  const std::string shortfall = shortfall_of(summary);
  const Independence independence(study, plan, result);
  std::vector<GateVerdict> verdicts;
  for (const Gate& gate : study.gates) {
    const bool by_cell = (gate.each_cell || !gate.cell.empty()) && !summary.cells.empty();
    std::vector<Values> values = values_for(gate, by_cell, plan, result);
    if (!by_cell) {
      verdicts.push_back(verdict_on({gate, independence, false}, summary.all, std::move(values.front()), shortfall));
      continue;
    }
    for (std::size_t i = 0; i < summary.cells.size(); ++i) {
      const Summary::Cell& cell = summary.cells[i];
      if (!is_in(cell.sweep, gate.cell)) continue;
      verdicts.push_back(verdict_on({gate, independence, true}, cell.statistics, std::move(values[i]), shortfall));
      verdicts.back().cell = cell.sweep;
    }
  }
  return verdicts;
}

}  // namespace steerstat
