#include "report/independence.hpp"

#include <algorithm>
#include <cmath>

#include "statistics/confidence_sequence.hpp"
#include "statistics/sample.hpp"

namespace steerstat {
namespace {

bool is_sequence(const Sampling& sampling) {
  return sampling.method == SamplingMethod::sobol ||
         (sampling.method == SamplingMethod::sobol_indices && sampling.base == SobolIndicesBase::sobol);
}

/// Whether draws differ at all: a study of sweeps alone has one, which is no sample of anything.
bool has_draws(const Study& study) {
  if (study.sampling.method == SamplingMethod::grid) return false;
  const auto is_drawn = [](const Input& input) { return std::holds_alternative<Distribution>(input.value); };
  return study.sampling.trials > 1 || std::any_of(study.inputs.begin(), study.inputs.end(), is_drawn);
}

}  // namespace

Independence::Independence(const Study& study, const Plan& plan, const StudyResult& result)
    : study_(study), plan_(plan), trials_(result.trials), sketch_(result.sketch ? &*result.sketch : nullptr) {}

IntervalUnit Independence::unit(bool in_cell) const {
  if (is_sequence(study_.sampling)) return IntervalUnit::none;
  return !in_cell && plan_.cells() > 1 && has_draws(study_) ? IntervalUnit::draw : IntervalUnit::trial;
}

std::string_view Independence::doubt() const {
  if (!is_sequence(study_.sampling)) return {};
  return "the points of Sobol's sequence are not independent, so that one scrambling tells no interval; gate on a "
         "study by monte_carlo or latin_hypercube";
}

/// The trials, or the values of a metric, that so many of a Latin hypercube count for.
double Independence::stratified(double trials) const {
  const auto n = static_cast<double>(study_.sampling.trials);
  return study_.sampling.method == SamplingMethod::latin_hypercube && n > 1.0 ? trials * ((n - 1.0) / n) : trials;
}

std::vector<ClusterSum> Independence::by_draw(const std::function<double(const TrialOutcome&)>& value) const {
  std::vector<ClusterSum> clusters;
  std::uint64_t last = 0;
  for (std::size_t row = 0; row < trials_.index.size(); ++row) {
    const std::uint64_t draw = trials_.index[row] / plan_.cells();
    if (clusters.empty() || draw != last) clusters.push_back({0, 0.0});
    last = draw;
    const double x = value(trials_.outcomes[row]);
    if (std::isnan(x)) continue;
    ++clusters.back().count;
    clusters.back().total += x;
  }
  return clusters;
}

/// A sketch has whole draws.
EqualClusters Independence::by_draw(Status outcome) const {
  const auto status = static_cast<std::size_t>(outcome);
  EqualClusters clusters;
  clusters.size = plan_.cells();
  clusters.clusters = sketch_->count() / clusters.size;
  for (const TrialSketch::Cell& cell : sketch_->cells()) clusters.successes += cell.outcomes[status];
  clusters.squares = sketch_->squares()[status];
  return clusters;
}

std::optional<ProportionInterval> Independence::rate(Status outcome, const TrialStatistics& statistics,
                                                     bool in_cell) const {
  const std::uint64_t n = statistics.completed;
  if (n == 0) return std::nullopt;
  if (seeks_failures(study_.sampling.method)) return statistics.success_rate;  // no other rate is asked for
  const auto& [method, level] = study_.intervals;
  if (unit(in_cell) == IntervalUnit::draw) {
    if (sketch_ != nullptr) return equal_clusters_proportion(method, by_draw(outcome), level);
    const auto sums = by_draw([&](const TrialOutcome& o) { return o.status == outcome ? 1.0 : 0.0; });
    return clustered_proportion(method, sums, level);
  }
  const std::uint64_t count = statistics.outcomes[static_cast<std::size_t>(outcome)];
  const auto trials = static_cast<double>(n);
  const double effective = stratified(trials);
  if (effective == trials || method == ProportionMethod::confidence_sequence) {
    return proportion_interval(method, count, n, level);
  }
  return proportion_interval_of_share(method, static_cast<double>(count) / trials, effective, level);
}

double Independence::effective_trials(const TrialStatistics& statistics, bool in_cell) const {
  if (unit(in_cell) != IntervalUnit::draw) return stratified(static_cast<double>(statistics.completed));
  const bool always = study_.intervals.method == ProportionMethod::confidence_sequence;
  if (sketch_ != nullptr) {
    const EqualClusters draws = by_draw(Status::converged);
    return always ? static_cast<double>(draws.clusters) : effective_trials_of_equal(draws, study_.intervals.level);
  }
  const auto sums = by_draw([](const TrialOutcome& o) { return o.status == Status::converged ? 1.0 : 0.0; });
  if (always) return static_cast<double>(sums.size());
  return steerstat::effective_trials(sums, study_.intervals.level);
}

SampleInterval Independence::mean(const Metric& metric, const SampleStatistics& sample, bool in_cell) const {
  const double level = study_.intervals.level;
  if (unit(in_cell) == IntervalUnit::draw) return clustered_mean(by_draw(metric.value), level);
  const auto n = static_cast<double>(sample.count);
  const double effective = stratified(n);
  if (effective == n || !sample.std) return mean_interval(sample.mean, sample.std, sample.count, level);
  return mean_interval(sample.mean, *sample.std * std::sqrt(n / effective), sample.count, level);
}

SampleInterval Independence::quantile(const Metric& metric, std::span<const double> sorted, double p,
                                      bool in_cell) const {
  const auto& [method, level] = study_.intervals;
  // Where the study may be looked at again and again, so must a quantile's interval hold.
  const bool always = method == ProportionMethod::confidence_sequence;
  if (unit(in_cell) == IntervalUnit::draw && !sorted.empty()) {
    const double estimate = steerstat::quantile(sorted, p);
    const auto sums = by_draw([&](const TrialOutcome& outcome) {
      const double x = metric.value(outcome);
      if (std::isnan(x)) return x;
      return x <= estimate ? 1.0 : 0.0;
    });
    return between(sorted, always ? clustered_confidence_sequence_ranks(sums, plan_.cells(), p, level)
                                  : clustered_quantile_ranks(sums, p, level));
  }
  return between(sorted, quantile_ranks_of_trials(sorted.size(), p));
}

QuantileRanks Independence::quantile_ranks_of_trials(std::uint64_t n, double p) const {
  const auto& [method, level] = study_.intervals;
  if (method == ProportionMethod::confidence_sequence) return confidence_sequence_ranks(n, p, level);
  const auto all = static_cast<double>(n);
  const double effective = std::floor(stratified(all));
  if (effective == all || effective < 1.0) return quantile_ranks(n, p, level);
  return stretched(quantile_ranks(static_cast<std::uint64_t>(effective), p, level), effective, n);
}

}  // namespace steerstat
