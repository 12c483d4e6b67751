#include "report/gates.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "json_text.hpp"
#include "statistics/confidence_sequence.hpp"
#include "statistics/sample_interval.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

using ::testing::HasSubstr;

/// A trial that converged after so many seconds, or timed out.
TrialOutcome trial(std::optional<double> settling_time) {
  TrialOutcome outcome;
  outcome.status = settling_time ? Status::converged : Status::timeout;
  outcome.end_time = settling_time.value_or(300.0);
  outcome.cycles = 3;
  return outcome;
}

/// The summary of a study with these gates, whose trials ended so.
Summary summary_of(const std::string& gates, const std::vector<TrialOutcome>& outcomes, std::uint64_t requested,
                   const std::string& controller = "{}") {
  const Study study = decode_study(R"({"sampling": {"trials": )" + std::to_string(requested) + R"(}, "controller": )" +
                                       controller + R"(, "gates": [)" + gates + "]}",
                                   {});
  StudyResult result;
  result.trials.outcomes = outcomes;
  for (std::size_t i = 0; i < outcomes.size(); ++i) result.trials.index.push_back(i);
  result.complete = outcomes.size() == Plan(study).trials();
  return summarise(study, result);
}

std::vector<TrialOutcome> converged(std::size_t successes, std::size_t trials) {
  std::vector<TrialOutcome> outcomes;
  for (std::size_t i = 0; i < trials; ++i) {
    outcomes.push_back(trial(i < successes ? std::optional(10.0 + static_cast<double>(i)) : std::nullopt));
  }
  return outcomes;
}

Verdict verdict(const char* metric, const char* expr, const std::vector<TrialOutcome>& outcomes) {
  const std::string gate = std::string(R"({"metric": ")") + metric + R"(", "expr": ")" + expr + R"("})";
  const Summary summary = summary_of(gate, outcomes, std::max<std::size_t>(outcomes.size(), 1));
  EXPECT_EQ(summary.gates.size(), 1U);
  return summary.gates.front().verdict;
}

/// The summary of a study by `sampling` with a gate on the success rate, of whose trials so many converged.
Summary sampled(const std::string& sampling, std::size_t successes, std::size_t trials) {
  const Study study = decode_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "sampling": )" + sampling +
                                       R"(, "gates": [{"metric": "success_rate", "expr": "ci_low > 0.1"},
                                                      {"metric": "settling_time", "expr": "p50 > 0"},
                                                      {"metric": "settling_time", "expr": "mean > 0"},
                                                      {"metric": "settling_time", "expr": "max > 0"},
                                                      {"metric": "timeout_rate", "expr": "ci_low <= 0.9"}]})",
                                   {});
  StudyResult result;
  result.trials.outcomes = converged(successes, trials);
  for (std::size_t i = 0; i < trials; ++i) result.trials.index.push_back(i);
  result.complete = true;
  return summarise(study, result);
}

TEST(JudgeGates, OnOneScramblingOfSobolsSequenceAreInconclusive) {
  const Summary summary = sampled(R"({"method": "sobol", "trials": 64})", 60, 64);
  ASSERT_EQ(summary.gates.size(), 5U);
  for (const std::size_t gate : {0U, 1U, 2U, 4U}) {
    EXPECT_EQ(summary.gates[gate].verdict, Verdict::inconclusive) << summary.gates[gate].metric;
    EXPECT_THAT(summary.gates[gate].reason, HasSubstr("one scrambling tells no interval"));
  }
  EXPECT_EQ(summary.gates[3].verdict, Verdict::pass) << "a maximum rests on no interval";
  EXPECT_EQ(summary.all.unit, IntervalUnit::none);
  const auto json = testing::ordered_json_of(summary_json(summary)).at("success_rate");
  EXPECT_EQ(json.at("unit"), "none");
  EXPECT_TRUE(json.at("effective_trials").is_null());
  EXPECT_THAT(summary_text(summary, false), HasSubstr("as if trials were independent"));
}

TEST(JudgeGates, OfALatinHypercubeCountOneTrialLess) {
  const Summary summary = sampled(R"({"method": "latin_hypercube", "trials": 100})", 60, 100);
  const ProportionInterval expected = proportion_interval_of_share(ProportionMethod::wilson, 0.6, 99.0, 0.95);
  EXPECT_DOUBLE_EQ(summary.all.success_rate->low, expected.low);
  EXPECT_DOUBLE_EQ(summary.all.success_rate->high, expected.high);
  EXPECT_EQ(summary.all.success_rate->estimate, 0.6);
  EXPECT_LT(expected.low, wilson_interval(60, 100, 0.95).low);
  EXPECT_DOUBLE_EQ(summary.all.effective_trials, 99.0);
  EXPECT_EQ(summary.all.unit, IntervalUnit::trial);
  EXPECT_EQ(summary.gates[0].interval.low, expected.low);
  const Summary independent = sampled(R"({"trials": 100})", 60, 100);
  EXPECT_EQ(independent.all.success_rate->low, wilson_interval(60, 100, 0.95).low);
  EXPECT_GT(*independent.gates[2].interval.low, *summary.gates[2].interval.low);
}

TEST(JudgeGates, OverAllCellsCountTheDrawsThatTheyShare) {
  // 45 of 50 draws converge, each in both cells or in none.
  std::vector<TrialOutcome> outcomes;
  for (std::size_t draw = 0; draw < 50; ++draw) {
    for (int cell = 0; cell < 2; ++cell) {
      outcomes.push_back(trial(draw < 45 ? std::optional(10.0 + static_cast<double>(draw)) : std::nullopt));
    }
  }
  const char* const gates = R"({"metric": "success_rate", "expr": "ci_low >= 0.8"},
                               {"metric": "success_rate", "expr": "ci_low >= 0.7"},
                               {"metric": "settling_time", "expr": "mean < 40"},
                               {"metric": "settling_time", "expr": "p50 < 40"},
                               {"metric": "success_rate", "expr": "ci_low >= 0.7", "scope": "each_cell"})";
  const Summary summary = summary_of(gates, outcomes, 50, R"({"contraction": {"eta1": {"sweep": [0.4, 0.5]}}})");
  EXPECT_EQ(summary.all.unit, IntervalUnit::draw);
  EXPECT_NEAR(summary.all.effective_trials, 49.0, 1.5);
  const ProportionInterval of_draws = wilson_interval(45, 50, 0.95);
  EXPECT_NEAR(summary.all.success_rate->low, of_draws.low, 5e-3);
  EXPECT_LT(summary.all.success_rate->low, of_draws.low);
  EXPECT_NEAR(summary.all.success_rate->high, of_draws.high, 5e-3);
  EXPECT_GT(wilson_interval(90, 100, 0.95).low, 0.8) << "what 100 independent trials would pass";
  EXPECT_EQ(summary.gates[0].verdict, Verdict::inconclusive);
  EXPECT_EQ(summary.gates[1].verdict, Verdict::pass);
  EXPECT_EQ(summary.cells.front().statistics.unit, IntervalUnit::trial);
  EXPECT_EQ(summary.cells.front().statistics.success_rate->low, of_draws.low);
  EXPECT_EQ(summary.gates[4].interval.low, of_draws.low);
  // Means and quantiles of the draws: each value is there twice.
  const SampleStatistics& times = *summary.all.of("settling_time");
  const double independent = *mean_interval(times.mean, times.std, times.count, 0.95).high - times.mean;
  EXPECT_NEAR((*summary.gates[2].interval.high - times.mean) / independent, std::sqrt(2.0), 0.05);
  std::vector<double> once;
  for (int i = 0; i < 45; ++i) once.push_back(10.0 + i);
  const SampleInterval median = quantile_interval(once, 0.5, 0.95);
  EXPECT_NEAR(*summary.gates[3].interval.low, *median.low, 1.0);
  EXPECT_NEAR(*summary.gates[3].interval.high, *median.high, 1.0);
}

TEST(JudgeGates, OfAGridAndOfSweepsAloneCountTrials) {
  const Summary swept = summary_of(R"({"metric": "success_rate", "expr": "estimate > 0"})", {trial(10.0), trial(20.0)},
                                   1, R"({"contraction": {"eta1": {"sweep": [0.4, 0.5]}}})");
  EXPECT_EQ(swept.all.unit, IntervalUnit::trial) << "nothing is drawn";
  EXPECT_EQ(swept.all.success_rate->low, wilson_interval(2, 2, 0.95).low);
}

TEST(JudgeGates, OfNoTrialAreInconclusiveButForCounts) {
  for (const char* rate : {"success_rate", "timeout_rate", "integrator_failed_rate"}) {
    for (const char* expr : {"ci_low >= 0", "ci_high <= 1", "estimate < 0.5"}) {
      EXPECT_EQ(verdict(rate, expr, {}), Verdict::inconclusive) << rate << ' ' << expr;
    }
  }
  for (const char* expr : {"mean < 1e9", "p95 < 1e9", "min > 0", "max < 1e9"}) {
    EXPECT_EQ(verdict("settling_time", expr, {}), Verdict::inconclusive) << expr;
  }
  const Summary summary = summary_of(R"({"metric": "success_rate", "expr": "count < 1"})", {}, 1);
  EXPECT_EQ(summary.gates.front().value, 0.0);
}

TEST(JudgeGates, OfOneTrialHardlyEverDecide) {
  EXPECT_EQ(verdict("success_rate", "ci_low >= 0.5", converged(1, 1)), Verdict::inconclusive);
  EXPECT_EQ(verdict("success_rate", "ci_low >= 0.2", converged(1, 1)), Verdict::pass);  // Wilson: 0.207 to 1
  EXPECT_EQ(verdict("success_rate", "ci_low >= 0.8", converged(0, 1)), Verdict::fail);  // Wilson: 0 to 0.793
  EXPECT_EQ(verdict("settling_time", "mean < 1000", converged(1, 1)), Verdict::inconclusive);
  EXPECT_EQ(verdict("settling_time", "p50 < 1000", converged(1, 1)), Verdict::inconclusive);
  EXPECT_EQ(verdict("settling_time", "max < 11", converged(1, 1)), Verdict::pass);
  EXPECT_EQ(verdict("settling_time", "count >= 1", converged(1, 1)), Verdict::pass);
  EXPECT_EQ(verdict("settling_time", "count >= 1", converged(0, 1)), Verdict::fail);
  EXPECT_EQ(verdict("settling_time", "max < 11", converged(0, 1)), Verdict::inconclusive) << "nothing settled";
}

TEST(JudgeGates, OfAllSuccessesAndOfAllFailures) {
  // Wilson for 400 of 400: 0.9905 to 1; for none: 0 to 0.0095.
  EXPECT_EQ(verdict("success_rate", "ci_low >= 0.99", converged(400, 400)), Verdict::pass);
  EXPECT_EQ(verdict("success_rate", "ci_low >= 0.995", converged(400, 400)), Verdict::inconclusive);
  EXPECT_EQ(verdict("success_rate", "estimate >= 1", converged(400, 400)), Verdict::inconclusive);
  EXPECT_EQ(verdict("timeout_rate", "ci_high <= 0.01", converged(400, 400)), Verdict::pass);
  EXPECT_EQ(verdict("timeout_rate", "ci_low <= 0", converged(400, 400)), Verdict::pass) << "none was seen";
  EXPECT_EQ(verdict("timeout_rate", "ci_low <= 0", converged(399, 400)), Verdict::fail);
  EXPECT_EQ(verdict("success_rate", "ci_low >= 0.01", converged(0, 400)), Verdict::fail);
  EXPECT_EQ(verdict("success_rate", "ci_high < 0.01", converged(0, 400)), Verdict::pass);
  EXPECT_EQ(verdict("timeout_rate", "ci_low >= 0.99", converged(0, 400)), Verdict::pass);
  EXPECT_EQ(verdict("settling_time", "p95 < 100", converged(0, 400)), Verdict::inconclusive);
}

TEST(JudgeGates, JudgeQuantilesByOrderStatisticsAndMeansByStudentsT) {
  // 10, 11, ..., 209 s. By scipy.stats.binom(200, 0.95).ppf, ranks 183 and 196; the mean is 109.5 +- 8.07 s.
  const std::string gates =
      R"({"metric": "settling_time", "expr": "p95 < 300"}, {"metric": "settling_time", "expr": "mean < 300"})";
  const Summary summary = summary_of(gates, converged(200, 200), 200);
  EXPECT_EQ(summary.gates[0].interval, (quantile_interval(
                                           [] {
                                             std::vector<double> values;
                                             for (int i = 0; i < 200; ++i) values.push_back(10.0 + i);
                                             return values;
                                           }(),
                                           0.95, 0.95)));
  EXPECT_EQ(summary.gates[0].value, summary.all.of("settling_time")->p95);
  EXPECT_NEAR(summary.gates[1].interval.low.value(), 109.5 - 8.07, 0.01);
  EXPECT_NEAR(summary.gates[1].interval.high.value(), 109.5 + 8.07, 0.01);
  EXPECT_EQ(summary.gates[1].value, 109.5);
}

const char* const two_sweeps = R"({"contraction": {"eta1": {"sweep": [0.3, 0.5]}, "eta2": {"sweep": [0.4, 0.6]}}})";

TEST(JudgeGates, LookAtTheCellsThatTheyAreOn) {
  // Four cells, trial i in cell i % 4: those of the last cell converge.
  std::vector<TrialOutcome> outcomes;
  for (int i = 0; i < 400; ++i) outcomes.push_back(trial(i % 4 == 3 ? std::optional(50.0 + i) : std::nullopt));
  const std::string gates = R"({"metric": "success_rate", "expr": "ci_low > 0.9"},
      {"metric": "success_rate", "expr": "ci_low > 0.9", "scope": "each_cell"},
      {"metric": "success_rate", "expr": "ci_low > 0.9", "cell": {"controller.contraction.eta1": 0.5}},
      {"metric": "settling_time", "expr": "p50 > 100",
       "cell": {"controller.contraction.eta1": 0.5, "controller.contraction.eta2": 0.6}})";
  const Summary summary = summary_of(gates, outcomes, 100, two_sweeps);
  ASSERT_EQ(summary.cells.size(), 4U);
  ASSERT_EQ(summary.cells[3].statistics.success_rate->estimate, 1.0);
  ASSERT_EQ(summary.gates.size(), 1U + 4U + 2U + 1U);
  EXPECT_TRUE(summary.gates[0].cell.empty());
  EXPECT_EQ(summary.gates[0].verdict, Verdict::fail);
  for (std::size_t cell = 0; cell < 4; ++cell) {
    EXPECT_EQ(summary.gates[1 + cell].verdict, cell == 3 ? Verdict::pass : Verdict::fail);
    EXPECT_EQ(summary.gates[1 + cell].cell.size(), 2U);
    EXPECT_EQ(summary.gates[1 + cell].cell[0].value, summary.cells[cell].sweep[0].value);
    EXPECT_EQ(summary.gates[1 + cell].cell[1].value, summary.cells[cell].sweep[1].value);
  }
  EXPECT_EQ(summary.gates[5].cell[0].value, 0.5);
  EXPECT_EQ(summary.gates[6].verdict, Verdict::pass);
  EXPECT_EQ(summary.gates[7].verdict, Verdict::pass);
  EXPECT_EQ(summary.gates[7].value, 251.0) << "of the cell's trials alone";
  EXPECT_EQ(gate_title(summary.gates[7]),
            "settling_time p50 > 100 (controller.contraction.eta1 = 0.5, controller.contraction.eta2 = 0.6)");
}

TEST(JudgeGates, InEachCellOfAStudyWithoutSweepsAreJudgedOnce) {
  const Summary summary = summary_of(R"({"metric": "success_rate", "expr": "ci_low > 0.9", "scope": "each_cell"})",
                                     converged(100, 100), 100);
  ASSERT_EQ(summary.gates.size(), 1U);
  EXPECT_TRUE(summary.gates[0].cell.empty());
  EXPECT_EQ(summary.gates[0].verdict, Verdict::pass);
}

TEST(JudgeGates, OfAnInterruptedStudySayWhatIsMissing) {
  const Summary summary =
      summary_of(R"({"metric": "success_rate", "expr": "ci_low > 0.9"})", converged(100, 100), 2000);
  EXPECT_EQ(summary.gates[0].verdict, Verdict::inconclusive);
  EXPECT_THAT(summary.gates[0].reason, HasSubstr("only 100 of 2,000 trials have finished"));
}

TEST(JudgeGates, OfAStudyThatStopsPassWhereItStoppedForPrecisionAlone) {
  const auto judged = [](const char* half_width, std::size_t trials) {
    const Study study =
        decode_study(std::string(R"({"sampling": {"trials": 100}, "stop": {"min_trials": 50, "check_every": 50,
            "until": [{"metric": "success_rate", "half_width": )") +
                         half_width + R"(}]}, "gates": [{"metric": "success_rate", "expr": "ci_low > 0.5"},
            {"metric": "settling_time", "expr": "p50 < 500"}, {"metric": "success_rate", "expr": "ci_high < 0.5"}]})",
                     {});
    StudyResult result;
    result.trials.outcomes = converged(trials, trials);
    for (std::size_t i = 0; i < trials; ++i) result.trials.index.push_back(i);
    result.complete = true;
    return summarise(study, result).gates;
  };
  const std::vector<GateVerdict> precise = judged("0.3", 50);
  EXPECT_EQ(precise[0].verdict, Verdict::pass) << precise[0].reason;
  EXPECT_EQ(precise[1].verdict, Verdict::pass) << precise[1].reason;
  std::vector<double> values;
  for (int i = 0; i < 50; ++i) values.push_back(10.0 + i);
  EXPECT_EQ(precise[1].interval, quantile_confidence_sequence(values, 0.5, 0.95));
  const std::vector<GateVerdict> ran_out = judged("0.001", 100);
  EXPECT_EQ(ran_out[0].verdict, Verdict::inconclusive);
  EXPECT_THAT(ran_out[0].reason, HasSubstr("but the trials ran out before the precision was reached"));
  EXPECT_EQ(ran_out[1].verdict, Verdict::inconclusive);
  EXPECT_EQ(ran_out[2].verdict, Verdict::fail) << "more trials do not mend it";
}

TEST(JudgeGates, ShowInTheJsonAndTheTable) {
  const std::string gates = R"({"metric": "success_rate", "expr": "0.9<ci_low"},
      {"metric": "settling_time", "expr": "p95 < 20", "scope": "each_cell"}, {"metric": "cycles", "expr": "max < 9"})";
  const Summary summary = summary_of(gates, converged(50, 100), 100);
  const auto json = testing::ordered_json_of(summary_json(summary)).at("gates");
  ASSERT_EQ(json.size(), 3U);
  EXPECT_EQ(json[0].at("metric"), "success_rate");
  EXPECT_EQ(json[0].at("expr"), "ci_low > 0.9");
  EXPECT_TRUE(json[0].at("cell").is_null());
  EXPECT_EQ(json[0].at("value").get<double>(), summary.all.success_rate->low);
  EXPECT_EQ(json[0].at("ci_high").get<double>(), summary.all.success_rate->high);
  EXPECT_EQ(json[0].at("verdict"), "fail");
  EXPECT_EQ(json[2].at("verdict"), "pass");
  EXPECT_TRUE(json[2].at("ci_low").is_null());
  EXPECT_EQ(json[2].at("reason"), "max is 3");
  const std::string text = summary_text(summary, false);
  EXPECT_THAT(text, HasSubstr("fail     success_rate ci_low > 0.9"));
  EXPECT_THAT(text, HasSubstr("pass     cycles max < 9"));
  EXPECT_THAT(summary_text(summary, true), HasSubstr("\x1b["));
}

}  // namespace
}  // namespace steerstat
