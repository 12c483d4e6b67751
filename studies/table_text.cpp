#include "table_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <span>

#include "study/plan.hpp"
#include "trial/metric.hpp"

namespace steerstat {
namespace {

/// The metrics after settling_time and cycles, which have columns of their own.
std::span<const Metric> further_metrics() {
  return metrics().subspan(2);
}

}  // namespace

std::string trajectory_csv(const Trajectory& trajectory) {
  std::string text = "t,q1,q2,q1_dot,q2_dot,a,tau,phase\n";
  const auto out = std::back_inserter(text);
  for (const TrajectorySample& sample : trajectory.samples) {
    fmt::format_to(out, "{},{},{},{},{},{},{},{}\n", sample.t, sample.state.q1, sample.state.q2, sample.state.q1_dot,
                   sample.state.q2_dot, sample.a, sample.tau, name_of(sample.phase));
  }
  return text;
}

std::string trials_csv(const StoredStudy& stored) {
  const Plan plan(stored.study);
  const bool is_weighted = stored.study.sampling.method == SamplingMethod::importance;
  std::string text = is_weighted ? "index,cell,weight" : "index,cell";
  for (const std::string& name : plan.varying()) text += ',' + name;
  text += ",status,settling_time,end_time,cycles,swings,alignments,passive_error,active_error,q1,q2,q1_dot,q2_dot";
  for (const Metric& metric : further_metrics()) fmt::format_to(std::back_inserter(text), ",{}", metric.name);
  text += '\n';
  const auto out = std::back_inserter(text);
  for (std::size_t row = 0; row < stored.result.trials.index.size(); ++row) {
    const std::uint64_t index = stored.result.trials.index[row];
    const TrialOutcome& end = stored.result.trials.outcomes[row];
    fmt::format_to(out, "{},{}", index, plan.cell_of(index));
    if (is_weighted) fmt::format_to(out, ",{}", plan.weight(index));
    for (const std::vector<double>& values : stored.parameters) fmt::format_to(out, ",{}", values[row]);
    fmt::format_to(out, ",{},", name_of(end.status));
    if (end.status == Status::converged) fmt::format_to(out, "{}", end.settling_time());
    fmt::format_to(out, ",{},{},{},{},{},{},{},{},{},{}", end.end_time, end.cycles, end.swings, end.alignments,
                   end.passive_error, end.active_error, end.end_state.q1, end.end_state.q2, end.end_state.q1_dot,
                   end.end_state.q2_dot);
    for (const Metric& metric : further_metrics()) {
      const double value = metric.value(end);
      text += ',';
      if (!std::isnan(value)) fmt::format_to(out, "{}", value);
    }
    text += '\n';
  }
  return text;
}

}  // namespace steerstat
