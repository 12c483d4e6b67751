#include "report/approximation_summary.hpp"

#include <cmath>

#include "core/version.hpp"
#include "robot/plant.hpp"
#include "statistics/slope.hpp"

namespace steerstat {
namespace {

constexpr std::array<ErrorMeasure, error_measure_count> every_measure{
    {{"position_end", "rad", [](const CycleError& e) { return e.end.position; }},
     {"velocity_end", "rad/s", [](const CycleError& e) { return e.end.velocity; }},
     {"state_end", "norm of rad and rad/s", [](const CycleError& e) { return e.end.state; }},
     {"position_worst", "rad", [](const CycleError& e) { return e.worst.position; }},
     {"velocity_worst", "rad/s", [](const CycleError& e) { return e.worst.velocity; }},
     {"state_worst", "norm of rad and rad/s", [](const CycleError& e) { return e.worst.state; }},
     {"position_step", "1", [](const CycleError& e) { return e.position_step; }},
     {"velocity_step", "1", [](const CycleError& e) { return e.velocity_step; }}}};

using Errors = std::span<const CycleError>;  // (cells x draws)

/// The logarithms of an input's sizes in the cells; empty where fewer than two are different.
std::vector<double> log_sizes(const CyclePlan& plan, CycleInput input) {
  std::vector<double> sizes;
  bool differ = false;
  for (std::uint64_t cell = 0; cell < plan.cells(); ++cell) {
    const std::optional<double> value = plan.swept(input, cell);
    if (!value) return {};
    sizes.push_back(std::log(std::abs(*value)));
    differ = differ || sizes.back() != sizes.front();
  }
  return differ ? sizes : std::vector<double>{};
}

std::optional<FittedOrder> fitted(const std::vector<double>& slopes) {
  const std::optional<SampleStatistics> sample = describe(slopes);
  if (!sample) return std::nullopt;
  FittedOrder order;
  order.draws = slopes.size();
  order.mean = sample->mean;
  if (sample->std) order.standard_error = *sample->std / std::sqrt(static_cast<double>(slopes.size()));
  order.interval = mean_interval(sample->mean, sample->std, slopes.size(), approximation_level);
  order.p05 = sample->p05;
  order.p50 = sample->p50;
  order.p95 = sample->p95;
  return order;
}

ApproximationSummary::Orders orders_of(const CyclePlan& plan, Errors errors, const ErrorMeasure& measure) {
  // Cells are a full factorial, in which sizes of A and T are orthogonal: the slope in one does not depend on the
  // other's being in the fit.
  const std::vector<double> amplitudes = log_sizes(plan, CycleInput::amplitude);
  const std::vector<double> periods = log_sizes(plan, CycleInput::period);
  std::vector<double> in_amplitude;
  std::vector<double> in_period;
  std::vector<double> along_dilations;
  std::vector<double> logs(plan.cells());
  for (std::uint64_t draw = 0; draw < plan.draws(); ++draw) {
    bool positive = true;
    for (std::uint64_t cell = 0; cell < plan.cells(); ++cell) {
      const double error = measure.value(errors[cell * plan.draws() + draw]);
      positive = positive && error > 0.0;
      logs[cell] = std::log(error);
    }
    if (!positive) continue;
    if (!amplitudes.empty()) in_amplitude.push_back(least_squares_slope(amplitudes, logs));
    if (!periods.empty()) in_period.push_back(least_squares_slope(periods, logs));
    if (!amplitudes.empty() && !periods.empty()) {
      along_dilations.push_back(2.0 * in_amplitude.back() + in_period.back());
    }
  }
  return {fitted(in_amplitude), fitted(in_period), fitted(along_dilations)};
}

ApproximationSummary::Cell summarise_cell(const CyclePlan& plan, Errors errors, std::uint64_t cell) {
  ApproximationSummary::Cell result;
  for (std::size_t i = 0; i < result.sweep.size(); ++i) result.sweep[i] = plan.swept(static_cast<CycleInput>(i), cell);
  std::vector<double> sample(plan.draws());
  for (std::size_t m = 0; m < every_measure.size(); ++m) {
    for (std::uint64_t draw = 0; draw < plan.draws(); ++draw) {
      sample[draw] = every_measure[m].value(errors[cell * plan.draws() + draw]);
    }
    result.errors[m] = *describe(sample);
  }
  return result;
}

}  // namespace

std::span<const ErrorMeasure, error_measure_count> error_measures() {
  return every_measure;
}

ApproximationSummary summarise(const ApproximationStudy& study, std::span<const CycleError> errors) {
  const CyclePlan plan(study);
  ApproximationSummary summary;
  summary.name = study.name;
  summary.engine_version = engine_version();
  summary.seed = study.seed;
  summary.coupling = coupling(study.plant);
  summary.tolerance = study.tolerance;
  summary.draws = plan.draws();
  for (std::uint64_t cell = 0; cell < plan.cells(); ++cell) {
    summary.cells.push_back(summarise_cell(plan, errors, cell));
  }
  for (std::size_t m = 0; m < every_measure.size(); ++m) summary.orders[m] = orders_of(plan, errors, every_measure[m]);
  return summary;
}

}  // namespace steerstat
