#include "report/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/readable.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

/// What of the pairs the statistics are made from.
struct PairTally {
  PairedCounts counts;
  std::vector<double> settling_time_differences;

  void add(const TrialOutcome& a, const TrialOutcome& b) {
    const bool in_a = a.status == Status::converged;
    const bool in_b = b.status == Status::converged;
    ++(in_a ? (in_b ? counts.both : counts.a_only) : (in_b ? counts.b_only : counts.neither));
    if (in_a && in_b) settling_time_differences.push_back(b.settling_time() - a.settling_time());
  }

  /// @param independent  whether the pairs are of different draws
  [[nodiscard]] PairedStatistics statistics(bool independent) {
    PairedStatistics result;
    result.counts = counts;
    if (independent && counts.pairs() > 0) {
      result.success_rate_difference = tango_interval(counts, comparison_level);
      result.test = mcnemar_test(counts);
    }
    std::vector<double>& sample = settling_time_differences;
    const std::optional<SampleStatistics> described = describe(sample);
    if (!described) return result;
    SettlingTimeDifference difference{sample.size(), *described, {}, {}};
    if (independent) {
      std::sort(sample.begin(), sample.end());
      difference.mean = mean_interval(described->mean, described->std, sample.size(), comparison_level);
      difference.median = quantile_interval(sample, 0.5, comparison_level);
    }
    result.settling_time_difference = difference;
    return result;
  }
};

Comparison::Side side_of(const ComparedStudy& compared) {
  return {study_id(compared.study),           compared.study.name,
          spec_sha256(compared.study),        compared.engine_version,
          compared.result.complete,           Plan(compared.study).trials(),
          compared.result.trials.index.size()};
}

std::vector<std::string> warnings_of(const Comparison& comparison, std::uint64_t pairs) {
  std::vector<std::string> warnings;
  const Comparison::Side& a = comparison.a;
  const Comparison::Side& b = comparison.b;
  if (a.engine_version != b.engine_version) {
    warnings.push_back(fmt::format("A was run by engine {}, B by {}: part of the difference may be theirs",
                                   a.engine_version, b.engine_version));
  }
  for (const Comparison::Side* side : {&a, &b}) {
    if (side->complete) continue;
    warnings.push_back(fmt::format("{} is incomplete: {} of {} trials finished", side == &a ? "A" : "B",
                                   readable_count(side->completed), readable_count(side->requested)));
  }
  if (pairs < std::max(a.completed, b.completed)) {
    warnings.push_back(fmt::format("only the {} trials that both have are paired (A has {}, B {})",
                                   readable_count(pairs), readable_count(a.completed), readable_count(b.completed)));
  }
  if (comparison.differences.empty()) warnings.emplace_back("the specs do not differ in anything that matters");
  return warnings;
}

void note(DiscordantTrials& trials, std::uint64_t index) {
  ++trials.count;
  if (trials.indices.size() < most_discordant_indices) trials.indices.push_back(index);
}

void adjust_for_the_number_of_cells(std::vector<Comparison::Cell>& cells) {
  std::vector<std::size_t> tested;
  std::vector<double> p_values;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!cells[i].statistics.test) continue;
    tested.push_back(i);
    p_values.push_back(cells[i].statistics.test->p_value);
  }
  const std::vector<double> adjusted = holm_adjusted(p_values);
  for (std::size_t i = 0; i < tested.size(); ++i) cells[tested[i]].statistics.holm_p_value = adjusted[i];
}

}  // namespace

Comparison compare(const ComparedStudy& a, const ComparedStudy& b) {
  Comparison comparison;
  comparison.differences = spec_differences(a.study, b.study);
  const Pairing pairing = pair_trials(a, b, comparison.differences);
  comparison.drawn = pairing.drawn;
  comparison.a = side_of(a);
  comparison.b = side_of(b);
  comparison.warnings = warnings_of(comparison, pairing.rows.size());

  const Plan plan(a.study);
  const std::uint64_t cells = plan.cells();
  PairTally all;
  std::vector<PairTally> tallies(cells > 1 ? cells : 0);
  for (const auto& [row_a, row_b] : pairing.rows) {
    const std::uint64_t index = a.result.trials.index[row_a];
    const TrialOutcome& in_a = a.result.trials.outcomes[row_a];
    const TrialOutcome& in_b = b.result.trials.outcomes[row_b];
    all.add(in_a, in_b);
    if (cells > 1) tallies[plan.cell_of(index)].add(in_a, in_b);
    const bool converged = in_a.status == Status::converged;
    if (converged != (in_b.status == Status::converged)) note(converged ? comparison.a_only : comparison.b_only, index);
  }
  comparison.all = all.statistics(cells == 1);
  for (std::uint64_t cell = 0; cell < tallies.size(); ++cell) {
    comparison.cells.push_back({plan.sweep_values(cell), tallies[cell].statistics(true)});
  }
  adjust_for_the_number_of_cells(comparison.cells);
  return comparison;
}

}  // namespace steerstat
