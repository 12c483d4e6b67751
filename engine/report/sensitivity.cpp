#include "report/sensitivity.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "statistics/given_data.hpp"

namespace steerstat {
namespace {

constexpr std::array<Metric, 2> outputs_of_all{
    {{"success", "1", [](const TrialOutcome& o) { return o.status == Status::converged ? 1.0 : 0.0; }},
     {"end_time", "s", [](const TrialOutcome& o) { return o.end_time; }}}};

// The rows of a pick-freeze design of which all trials have the output, (rows x variants).
std::vector<double> whole_rows(const Metric& output, std::uint64_t variants, const TrialTable& trials) {
  std::vector<double> rows;
  std::vector<double> row;
  std::uint64_t begin = 0;  // index of the row's first trial
  for (std::size_t i = 0; i < trials.index.size(); ++i) {
    const std::uint64_t index = trials.index[i];
    if (row.empty() || index != begin + row.size()) {  // a row begins, or one is broken off
      row.clear();
      if (index % variants != 0) continue;
      begin = index;
    }
    const double value = output.value(trials.outcomes[i]);
    if (!std::isfinite(value)) {
      row.clear();
      continue;
    }
    row.push_back(value);
    if (row.size() < variants) continue;
    rows.insert(rows.end(), row.begin(), row.end());
    row.clear();
  }
  return rows;
}

}  // namespace

std::optional<Metric> find_output(std::string_view name) {
  for (const Metric& output : outputs_of_all) {
    if (output.name == name) return output;
  }
  const Metric* metric = find_metric(name);
  if (metric == nullptr) return std::nullopt;
  return *metric;
}

std::vector<std::string_view> output_names() {
  std::vector<std::string_view> names;
  names.reserve(std::size(outputs_of_all) + metrics().size());
  for (const Metric& output : outputs_of_all) names.push_back(output.name);
  for (const Metric& metric : metrics()) names.push_back(metric.name);
  return names;
}

std::optional<SobolSensitivity> sobol_sensitivity(const Study& study, const Plan& plan, const TrialTable& trials) {
  if (study.sampling.method != SamplingMethod::sobol_indices) return std::nullopt;
  SobolSensitivity result;
  result.level = study.intervals.level;
  result.inputs = plan.varying();
  result.independent_trials = static_cast<std::uint64_t>(std::count_if(
      trials.index.begin(), trials.index.end(), [&](std::uint64_t index) { return plan.is_independent(index); }));
  for (const char* name : {"success", "settling_time", "end_time"}) {
    const std::vector<double> rows = whole_rows(*find_output(name), plan.variants(), trials);
    result.outputs.push_back({name, rows.size() / plan.variants(),
                              pick_freeze_indices(rows, result.inputs.size(), {result.level, study.sampling.seed})});
  }
  return result;
}

GivenDataSensitivity given_data_sensitivity(const Study& study, const StudyResult& result,
                                            std::span<const std::vector<double>> parameters,
                                            std::span<const Metric> outputs) {
  const Plan plan(study);
  const TrialTable& trials = result.trials;
  GivenDataSensitivity sensitivity;
  sensitivity.level = study.intervals.level;
  sensitivity.inputs = plan.varying();
  sensitivity.exact = study.sampling.method == SamplingMethod::grid && result.complete;
  for (const Metric& output : outputs) {
    std::vector<double> y;
    std::vector<std::uint64_t> draws;
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < trials.index.size(); ++row) {
      const double value = output.value(trials.outcomes[row]);
      if (!std::isfinite(value) || !plan.is_independent(trials.index[row])) continue;
      y.push_back(value);
      draws.push_back(trials.index[row] / plan.cells());
      rows.push_back(row);
    }
    GivenDataSensitivity::Output of_output{std::string(output.name), y.size(), {}};
    const GivenData given(y, draws, {sensitivity.level, study.sampling.seed});
    for (const std::vector<double>& column : parameters) {
      std::vector<double> x;
      x.reserve(rows.size());
      for (const std::size_t row : rows) x.push_back(column[row]);
      of_output.indices.push_back(sensitivity.exact ? factorial_index(x, y) : given.first_order(x));
    }
    sensitivity.outputs.push_back(std::move(of_output));
  }
  return sensitivity;
}

}  // namespace steerstat
