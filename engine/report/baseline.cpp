#include "report/baseline.hpp"

#include <fmt/format.h>

#include "core/errors.hpp"
#include "report/readable.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

Judgement judge_drop(const ProportionDrop& drop, const BaselineTest& test, const std::optional<double>& detectable,
                     std::string_view shortfall) {
  const std::string limits = fmt::format("limits {:.3g} to {:.3g}", drop.low, drop.high);
  if (drop.low > 0.0) return {Verdict::fail, fmt::format("a significant drop at level {}, {}", test.level, limits)};
  if (drop.high < test.margin) {
    std::string reason = fmt::format("a drop of {} is ruled out at level {}, {}", test.margin, test.level, limits);
    if (shortfall.empty()) return {Verdict::pass, std::move(reason)};
    return {Verdict::inconclusive, fmt::format("would pass ({}), but {}", reason, shortfall)};
  }
  const std::string found = detectable ? fmt::format("power {} is for drops from {:.3g} on", test.power, *detectable)
                                       : "so few trials show no drop whatever";
  return {Verdict::inconclusive, fmt::format("{}: {}; run more trials", limits, found)};
}

}  // namespace

void require_same_population(const Study& study, const Baseline& baseline) {
  if (Plan(study).cells() > 1) {
    throw BadUsage("--baseline: this study has sweeps, and a baseline one success rate; run one cell");
  }
  if (population_sha256(study) == baseline.population_sha256) return;
  throw BadUsage(fmt::format(
      "--baseline: the summary of {} is of other trials than this study's: its nominal plant, plant, initial state, "
      "goal, horizon or convergence tolerances differ, so that the success rates do not compare; make a baseline of "
      "this study with run --summary",
      printable(baseline.name)));
}

void judge_against(const Baseline& baseline, const BaselineTest& test, Summary& summary) {
  GateVerdict gate;
  gate.metric = "success_rate";
  gate.expr = fmt::format("drop < {}", test.margin);
  const std::string shortfall = shortfall_of(summary);
  BaselineComparison comparison{baseline.id,   baseline.name,      baseline.engine_version,
                                baseline.seed, baseline.converged, test,
                                std::nullopt,  std::nullopt};
  if (summary.all.completed == 0) {
    gate.reason = shortfall.empty() ? "no data" : fmt::format("no data; {}", shortfall);
  } else {
    const ProportionCount now{summary.all.outcomes[static_cast<std::size_t>(Status::converged)], summary.all.completed};
    const ProportionDrop drop = proportion_drop(baseline.converged, now, test.level);
    comparison.drop = drop;
    comparison.detectable_drop = detectable_drop(baseline.converged, now.trials, test.level, test.power);
    gate.value = drop.estimate;
    gate.interval = {drop.low, drop.high};
    auto [verdict, reason] = judge_drop(drop, test, comparison.detectable_drop, shortfall);
    gate.verdict = verdict;
    gate.reason = std::move(reason);
  }
  summary.baseline = std::move(comparison);
  summary.gates.push_back(std::move(gate));
}

}  // namespace steerstat
