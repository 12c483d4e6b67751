#include "report/baseline.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/errors.hpp"
#include "report/readable.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

using Sweep = std::vector<Plan::SweptValue>;

/// Whether two cells have the same values, in whatever order they are named.
bool same_cell(const Sweep& a, const Sweep& b) {
  const auto is_in_b = [&](const Plan::SweptValue& x) {
    return std::any_of(b.begin(), b.end(),
                       [&](const Plan::SweptValue& y) { return x.name == y.name && x.value == y.value; });
  };
  return a.size() == b.size() && std::all_of(a.begin(), a.end(), is_in_b);
}

/// @return null where there is no such cell
const Baseline::Cell* find_cell(const Baseline& baseline, const Sweep& sweep) {
  const auto found = std::find_if(baseline.cells.begin(), baseline.cells.end(),
                                  [&](const Baseline::Cell& cell) { return same_cell(cell.sweep, sweep); });
  return found == baseline.cells.end() ? nullptr : &*found;
}

std::string cell_text(const Sweep& sweep) {
  std::string text;
  for (const Plan::SweptValue& swept : sweep) {
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", swept.name, swept.value);
  }
  return text;
}

void require_same_cells(const Plan& plan, const Baseline& baseline) {
  const bool is_swept = !plan.sweep_values(0).empty();
  if (is_swept == baseline.cells.empty()) {
    throw BadUsage(is_swept ? "--baseline: this study has sweeps, and the baseline has not (cells compare with cells); "
                              "make a baseline of this study with run --summary"
                            : "--baseline: the baseline has sweeps, and this study has not (cells compare with cells); "
                              "make a baseline of this study with run --summary");
  }
  if (!is_swept) return;
  for (std::uint64_t cell = 0; cell < plan.cells(); ++cell) {
    const Sweep sweep = plan.sweep_values(cell);
    if (find_cell(baseline, sweep) != nullptr) continue;
    throw BadUsage(
        fmt::format("--baseline: the summary of {} has no cell {} (cells compare with cells); make a "
                    "baseline of this study with run --summary",
                    printable(baseline.name), cell_text(sweep)));
  }
  if (baseline.cells.size() == plan.cells()) return;
  throw BadUsage(
      fmt::format("--baseline: the summary of {} has {} cells, and this study {} (cells compare with cells); "
                  "make a baseline of this study with run --summary",
                  printable(baseline.name), baseline.cells.size(), plan.cells()));
}

/// One success rate held against another's.
struct Held {
  std::optional<ProportionDrop> drop;
  std::optional<double> detectable;
  GateVerdict gate;
};

/// @param drop   its lower limit at the level over `cells`, its upper limit at the level
/// @param cells  that are compared, 1 without sweeps
Judgement judge_drop(const Held& comparison, const BaselineTest& test, std::size_t cells, std::string_view shortfall) {
  const ProportionDrop& drop = *comparison.drop;
  const std::string limits = fmt::format("limits {:.3g} to {:.3g}", drop.low, drop.high);
  const std::string among = cells > 1 ? fmt::format(" over {} cells", cells) : "";
  if (drop.low > 0.0) {
    return {Verdict::fail, fmt::format("a significant drop at level {}{}, {}", test.level, among, limits)};
  }
  if (drop.high < test.margin) {
    std::string reason = fmt::format("a drop of {} is ruled out at level {}, {}", test.margin, test.level, limits);
    if (shortfall.empty()) return {Verdict::pass, std::move(reason)};
    return {Verdict::inconclusive, fmt::format("would pass ({}), but {}", reason, shortfall)};
  }
  const std::string found =
      comparison.detectable ? fmt::format("power {} is for drops from {:.3g} on", test.power, *comparison.detectable)
                            : "so few trials show no drop whatever";
  return {Verdict::inconclusive, fmt::format("{}: {}; run more trials", limits, found)};
}

Held hold(const ProportionCount& before, const TrialStatistics& statistics, const BaselineTest& test, std::size_t cells,
          std::string_view shortfall) {
  Held result;
  GateVerdict& gate = result.gate;
  gate.metric = "success_rate";
  gate.expr = fmt::format("drop < {}", test.margin);
  if (statistics.completed == 0) {
    gate.reason = shortfall.empty() ? "no data" : fmt::format("no data; {}", shortfall);
    return result;
  }
  const ProportionCount now{statistics.outcomes[static_cast<std::size_t>(Status::converged)], statistics.completed};
  const double level_in_cell = test.level / static_cast<double>(cells);
  ProportionDrop drop = proportion_drop(before, now, level_in_cell);
  if (cells > 1) drop.high = proportion_drop(before, now, test.level).high;
  result.drop = drop;
  result.detectable = detectable_drop(before, now.trials, level_in_cell, test.power);
  gate.value = drop.estimate;
  gate.interval = {drop.low, drop.high};
  auto [verdict, reason] = judge_drop(result, test, cells, shortfall);
  gate.verdict = verdict;
  gate.reason = std::move(reason);
  if (statistics.unit == IntervalUnit::none) {
    gate.verdict = Verdict::inconclusive;
    gate.reason =
        "one scrambling of Sobol's sequence tells no limits; hold a study by monte_carlo or latin_hypercube against "
        "the baseline";
  }
  return result;
}

}  // namespace

void require_same_population(const Study& study, const Baseline& baseline) {
  if (seeks_failures(study.sampling.method)) {
    throw BadUsage(
        "--baseline: the study's trials are drawn where failures are (a baseline compares counts of plain trials); use "
        "monte_carlo, or a gate on success_rate");
  }
  require_same_cells(Plan(study), baseline);
  if (population_sha256(study) == baseline.population_sha256) return;
  throw BadUsage(fmt::format(
      "--baseline: the summary of {} is of other trials than this study's: its nominal plant, plant, initial state, "
      "goal, horizon or convergence tolerances differ, so that the success rates do not compare; make a baseline of "
      "this study with run --summary",
      printable(baseline.name)));
}

void judge_against(const Baseline& baseline, const BaselineTest& test, Summary& summary) {
  const std::string shortfall = shortfall_of(summary);
  BaselineComparison comparison{baseline.id,   baseline.name,      baseline.engine_version,
                                baseline.seed, baseline.converged, test,
                                std::nullopt,  std::nullopt,       {}};
  if (summary.cells.empty()) {
    Held whole = hold(baseline.converged, summary.all, test, 1, shortfall);
    comparison.drop = whole.drop;
    comparison.detectable_drop = whole.detectable;
    summary.gates.push_back(std::move(whole.gate));
  }
  for (const Summary::Cell& cell : summary.cells) {
    const Baseline::Cell* before = find_cell(baseline, cell.sweep);
    if (before == nullptr) throw BadUsage("--baseline: it has no cell " + cell_text(cell.sweep));
    Held part = hold(before->converged, cell.statistics, test, summary.cells.size(), shortfall);
    part.gate.cell = cell.sweep;
    comparison.cells.push_back({cell.sweep, before->converged, part.drop, part.detectable});
    summary.gates.push_back(std::move(part.gate));
  }
  summary.baseline = std::move(comparison);
}

}  // namespace steerstat
