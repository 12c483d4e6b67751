#include "view/study_view.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <numeric>

#include "report/sensitivity.hpp"
#include "statistics/clustered.hpp"
#include "study/inputs.hpp"
#include "study/spec_json.hpp"
#include "view/study_columns.hpp"

namespace steerstat {
namespace {

/// The pieces that every part of a study's view is made of.
struct Trials {
  const ViewedStudy& viewed;
  const Plan plan;
  const std::vector<std::size_t> rows;        // of the trials that count
  const std::vector<std::uint8_t> converged;  // (rows)

  explicit Trials(const ViewedStudy& study)
      : viewed(study),
        plan(study.study),
        rows(rows_that_count(plan, study.result.trials)),
        converged(converged_among(study.result.trials, rows)) {}

  [[nodiscard]] const TrialOutcome& outcome(std::size_t row) const { return viewed.result.trials.outcomes[row]; }
};

std::vector<EmpiricalDistribution> distributions_of(const Trials& trials) {
  const Study& study = trials.viewed.study;
  const std::string obstacle = obstacle_to_band(study, trials.plan.cells());
  std::vector<EmpiricalDistribution> distributions;
  for (const Metric& metric : metrics()) {
    std::vector<double> values;
    values.reserve(trials.rows.size());
    for (const std::size_t row : trials.rows) {
      if (const double value = metric.value(trials.outcome(row)); !std::isnan(value)) values.push_back(value);
    }
    if (values.empty()) continue;
    distributions.push_back(empirical_distribution(std::string(metric.name), std::string(metric.unit),
                                                   std::move(values), obstacle, study.intervals.level));
  }
  return distributions;
}

StudyView::CycleCounts cycles_of(const Trials& trials) {
  constexpr std::uint64_t most_bins = 60;
  StudyView::CycleCounts counts;
  if (trials.rows.empty()) return counts;
  std::uint64_t least = trials.outcome(trials.rows.front()).cycles;
  std::uint64_t most = least;
  for (const std::size_t row : trials.rows) {
    least = std::min<std::uint64_t>(least, trials.outcome(row).cycles);
    most = std::max<std::uint64_t>(most, trials.outcome(row).cycles);
  }
  const std::uint64_t width = (most - least) / most_bins + 1;
  for (std::uint64_t from = least; from <= most; from += width) {
    counts.from.push_back(from);
    counts.to.push_back(from + width - 1);
    counts.converged.push_back(0);
    counts.others.push_back(0);
  }
  for (std::size_t i = 0; i < trials.rows.size(); ++i) {
    const std::uint64_t bin = (trials.outcome(trials.rows[i]).cycles - least) / width;
    ++(trials.converged[i] != 0 ? counts.converged : counts.others)[bin];
  }
  return counts;
}

StudyView::VaryingInputView varying_view(const Trials& trials, std::size_t position) {
  const std::string& name = trials.plan.varying()[position];
  const VaryingInput varying = varying_input(trials.viewed.study, name);
  using Source = StudyView::VaryingInputView::Source;
  const Source source = varying.listed                                        ? Source::listed
                        : std::holds_alternative<Sweep>(varying.input->value) ? Source::swept
                                                                              : Source::drawn;
  StudyView::VaryingInputView view{name, std::string(find_input(name)->unit), source, varying.input->value, {}, {}};
  const std::vector<double>& column = trials.viewed.parameters[position];
  for (const std::size_t row : trials.rows) {
    view.low = std::min(view.low.value_or(column[row]), column[row]);
    view.high = std::max(view.high.value_or(column[row]), column[row]);
  }
  return view;
}

/// (bins x draws in them) the successes of each draw: its trials in several cells go together.
std::vector<std::vector<ClusterSum>> draws_in_bins(const Trials& trials, const std::vector<std::uint16_t>& bin,
                                                   std::size_t bins) {
  std::vector<std::vector<ClusterSum>> draws(bins);
  std::vector<std::uint64_t> last(bins);
  for (std::size_t i = 0; i < bin.size(); ++i) {
    if (bin[i] == outside_axis) continue;
    const std::uint64_t draw = trials.viewed.result.trials.index[trials.rows[i]] / trials.plan.cells();
    std::vector<ClusterSum>& here = draws[bin[i]];
    if (here.empty() || last[bin[i]] != draw) here.push_back({0, 0.0});
    last[bin[i]] = draw;
    ++here.back().count;
    here.back().total += trials.converged[i];
  }
  return draws;
}

Marginal marginal_of(const Trials& trials, std::size_t position) {
  constexpr std::size_t most_bins = 24;
  const double level = trials.viewed.study.intervals.level;
  const VaryingInput varying = varying_input(trials.viewed.study, trials.plan.varying()[position]);
  const std::vector<double> values = values_of(trials.viewed.parameters[position], trials.rows);
  Marginal marginal;
  marginal.axis = axis_of(*varying.input, varying.listed, values, most_bins);
  const std::size_t bins = marginal.axis.bins();
  const std::vector<std::uint16_t> bin = bin_numbers(marginal.axis, values);
  marginal.counts = count_bins(bins, bin, trials.converged);
  const bool by_draw = trials.plan.cells() > 1 && draws(trials.viewed.study.sampling.method);
  std::vector<std::vector<ClusterSum>> clusters;
  if (by_draw) clusters = draws_in_bins(trials, bin, bins);
  for (std::size_t k = 0; k < bins; ++k) {
    const std::uint64_t n = marginal.counts.trials[k];
    if (n == 0) {
      marginal.intervals.emplace_back();
    } else if (by_draw) {
      marginal.intervals.push_back(clustered_proportion(ProportionMethod::wilson, clusters[k], level));
    } else {
      marginal.intervals.push_back(wilson_interval(marginal.counts.successes[k], n, level));
    }
  }
  return marginal;
}

std::vector<StudyView::SweptAxis> swept_axes(const Trials& trials) {
  std::vector<StudyView::SweptAxis> axes;
  for (const std::string& name : trials.plan.varying()) {
    const VaryingInput varying = varying_input(trials.viewed.study, name);
    const auto* sweep = std::get_if<Sweep>(&varying.input->value);
    if (sweep == nullptr || varying.listed) continue;
    axes.push_back({name, std::string(find_input(name)->unit), sweep->values});
  }
  return axes;
}

/// Sets given_data and sensitivity_of, and touches nothing else of the view.
void add_sensitivity(const Trials& trials, StudyView& view) {
  const std::array<Metric, 2> outputs{*find_output("success"), *find_output("settling_time")};
  const StudyResult& result = trials.viewed.result;
  const bool exact = trials.viewed.study.sampling.method == SamplingMethod::grid && result.complete;
  view.sensitivity_of = trials.rows.size();
  if (exact || trials.rows.size() <= most_sensitivity_trials) {
    view.given_data = given_data_sensitivity(trials.viewed.study, result, trials.viewed.parameters, outputs);
    return;
  }
  view.sensitivity_of = most_sensitivity_trials;
  const std::size_t end = trials.rows[most_sensitivity_trials];
  const auto first = [end](const auto& column) {
    return std::vector(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(end));
  };
  StudyResult some;
  some.trials = {first(result.trials.index), first(result.trials.outcomes)};
  std::vector<std::vector<double>> parameters;
  for (const std::vector<double>& column : trials.viewed.parameters) parameters.push_back(first(column));
  view.given_data = given_data_sensitivity(trials.viewed.study, some, parameters, outputs);
}

StudyView::Sample sample_of(const Trials& trials) {
  // A page of 5 MB holds so many numbers of trials, however many inputs vary.
  constexpr std::size_t most_numbers = 150'000;
  const std::size_t columns = trials.viewed.parameters.size() + 3;
  StudyView::Sample sample;
  sample.of = trials.rows.size();
  const std::vector<std::size_t> rows =
      chosen_rows(trials.viewed.result.trials, trials.rows, std::min(most_shown_trials, most_numbers / columns));
  for (const std::size_t row : rows) {
    sample.index.push_back(trials.viewed.result.trials.index[row]);
    sample.status.push_back(trials.outcome(row).status);
    sample.settling_time.push_back(trials.outcome(row).settling_time());
  }
  for (const std::vector<double>& column : trials.viewed.parameters) sample.inputs.push_back(values_of(column, rows));
  return sample;
}

StudyView::Failures failures_of(const Trials& trials) {
  StudyView::Failures failed;
  for (std::size_t i = 0; i < trials.rows.size(); ++i) {
    if (trials.converged[i] != 0) continue;
    ++failed.of;
    if (failed.index.size() == most_listed_failures) continue;
    const std::size_t row = trials.rows[i];
    failed.index.push_back(trials.viewed.result.trials.index[row]);
    failed.status.push_back(trials.outcome(row).status);
    failed.end_time.push_back(trials.outcome(row).end_time);
  }
  return failed;
}

/// Positions of the inputs, that of the greatest index of success first.
std::vector<std::size_t> by_influence(const GivenDataSensitivity& given, std::size_t inputs) {
  std::vector<std::size_t> order(inputs);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto index = [&](std::size_t i) {
    const auto& of_success = given.outputs.front().indices[i];
    return of_success ? of_success->estimate : 0.0;
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return index(i) > index(j); });
  return order;
}

std::vector<SuccessMap> maps_of(const Trials& trials, const GivenDataSensitivity& given, std::size_t most) {
  std::vector<SuccessMap> maps;
  if (trials.rows.empty()) return maps;
  MapMaker maker(trials.viewed);
  const std::vector<std::size_t> order = by_influence(given, trials.plan.varying().size());
  for (std::size_t later = 1; later < order.size(); ++later) {
    for (std::size_t earlier = 0; earlier < later; ++earlier) {
      if (maps.size() == most) return maps;
      maps.push_back(maker.map(order[earlier], order[later]));
    }
  }
  return maps;
}

}  // namespace

ShownRows shown_rows(const Study& study) {
  if (seeks_failures(study.sampling.method)) return ShownRows::sought;
  switch (study.store) {
    case Store::all:
      return ShownRows::all;
    case Store::failed:
      return ShownRows::failed;
    case Store::summary:
      break;
  }
  return ShownRows::none;
}

StudyView study_view(const ViewedStudy& viewed, const StudyViewOptions& options) {
  const Trials trials(viewed);
  StudyView view;
  view.created = options.created;
  view.spec = canonical_spec(viewed.study);
  view.rows = shown_rows(viewed.study);
  view.used = viewed.result.sketch ? viewed.result.finished() : trials.rows.size();
  for (std::size_t i = 0; i < trials.plan.varying().size(); ++i) view.inputs.push_back(varying_view(trials, i));
  view.sweeps = swept_axes(trials);
  view.sample = sample_of(trials);
  view.failed = failures_of(trials);
  view.narrowing.intervals = viewed.study.intervals;
  if (view.rows != ShownRows::all) return view;
  // Indices take about as long as sorting every metric or all the rest: each is done beside the others.
  auto sensitivity = std::async(std::launch::async, [&] { add_sensitivity(trials, view); });
  auto distributions = std::async(std::launch::async, [&] { return distributions_of(trials); });
  view.narrowing = narrowing_of(viewed);
  view.cycles = cycles_of(trials);
  if (!trials.rows.empty()) {
    for (std::size_t i = 0; i < view.inputs.size(); ++i) view.marginals.push_back(marginal_of(trials, i));
  }
  sensitivity.get();
  view.distributions = distributions.get();
  if (view.sample.index.size() < view.sample.of) view.maps = maps_of(trials, view.given_data, options.most_maps);
  return view;
}

}  // namespace steerstat
