#include "report/baseline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/errors.hpp"
#include "json_text.hpp"
#include "sample_summary.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

using namespace testing_report;
using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

Baseline baseline_of(std::uint64_t successes, std::uint64_t trials) {
  Baseline baseline;
  baseline.name = "earlier";
  baseline.converged = {successes, trials};
  return baseline;
}

/// The verdict on so many successes, held against a baseline.
GateVerdict held(const ProportionCount& before, const ProportionCount& now, const BaselineTest& test = {}) {
  Summary summary = made_up_summary({now.successes, now.trials - now.successes, 0, 0, 0});
  judge_against(baseline_of(before.successes, before.trials), test, summary);
  EXPECT_EQ(summary.gates.size(), 1U);
  return summary.gates.back();
}

std::string mistakes_in(const std::string& text) {
  try {
    read_baseline(text);
  } catch (const BadSpec& bad) {
    return bad.what();
  }
  return "";
}

TEST(Baseline, IsReadFromASummary) {
  Summary summary = made_up_summary({70, 20, 10, 0, 0});
  summary.population_sha256 = std::string(64, 'b');
  const Baseline baseline = read_baseline(summary_json(summary));
  EXPECT_EQ(baseline.name, "sample");
  EXPECT_EQ(baseline.id, summary.id);
  EXPECT_EQ(baseline.seed, 7U);
  EXPECT_EQ(baseline.population_sha256, summary.population_sha256);
  EXPECT_EQ(baseline.converged.successes, 70U);
  EXPECT_EQ(baseline.converged.trials, 100U);
}

TEST(Baseline, IsRefusedWithEverythingThatIsAmiss) {
  EXPECT_THAT(mistakes_in("{"), HasSubstr("line 1"));
  EXPECT_THAT(mistakes_in("[]"), HasSubstr("an array is not an object: a summary is {...}"));
  const std::string of_nothing = mistakes_in("{}");
  for (const char* key : {"study", "complete", "outcomes"}) {
    EXPECT_THAT(of_nothing, HasSubstr(std::string("\"") + key + "\" is missing"));
  }
  const Json good = testing::ordered_json_of(summary_json(made_up_summary({70, 30, 0, 0, 0})));
  ASSERT_EQ(mistakes_in(testing::text_of(good)), "");
  Json interrupted = good;
  interrupted["complete"] = false;
  EXPECT_THAT(mistakes_in(testing::text_of(interrupted)), HasSubstr("/complete: the study was interrupted"));
  Json empty = good;
  for (Json& count : empty["outcomes"]) count = 0;
  EXPECT_THAT(mistakes_in(testing::text_of(empty)), HasSubstr("/outcomes: no trial has finished"));
  Json huge = good;
  for (Json& count : huge["outcomes"]) count = std::numeric_limits<std::uint64_t>::max();
  EXPECT_THAT(mistakes_in(testing::text_of(huge)), HasSubstr("/outcomes: the counts add up to too much"));
  Json text = good;
  text["outcomes"]["timeout"] = "100";
  EXPECT_THAT(mistakes_in(testing::text_of(text)), HasSubstr("/outcomes/timeout: \"100\" is not an integer"));
  Json sequence = good;
  sequence["success_rate"]["unit"] = "none";
  EXPECT_THAT(mistakes_in(testing::text_of(sequence)),
              HasSubstr("/success_rate/unit: one scrambling of Sobol's sequence"));
  Json swept = testing::ordered_json_of(summary_json(made_up_sweep(3)));
  ASSERT_EQ(mistakes_in(testing::text_of(swept)), "");
  swept["cells"][1]["sweep"]["controller.contraction.eta1"] = "low";
  for (Json& count : swept["cells"][2]["outcomes"]) count = 0;
  EXPECT_THAT(mistakes_in(testing::text_of(swept)), HasSubstr("/cells/1/sweep/controller.contraction.eta1: \"low\""));
  EXPECT_THAT(mistakes_in(testing::text_of(swept)), HasSubstr("/cells/2/outcomes: no trial has finished"));
}

TEST(Baseline, MustBeOfThePopulationThatTheStudyIsOf) {
  const Study study = decode_study(R"({"name": "here", "controller": {"alignment": {"kd": 1}}})", {});
  Baseline baseline = baseline_of(7, 10);
  baseline.population_sha256 = population_sha256(decode_study(R"({"sampling": {"trials": 9}})", {}));
  EXPECT_NO_THROW(require_same_population(study, baseline));
  baseline.population_sha256 = population_sha256(decode_study(R"({"goal": {"q2": 0.5}})", {}));
  EXPECT_THROW(require_same_population(study, baseline), BadUsage);
}

std::string refusal(const char* controller, const Baseline& baseline) {
  try {
    require_same_population(decode_study(std::string(R"({"controller": )") + controller + "}", {}), baseline);
  } catch (const BadUsage& bad) {
    return bad.what();
  }
  return "";
}

TEST(Baseline, OfAStudyWithSweepsMustHaveItsCells) {
  Baseline baseline = baseline_of(7, 20);
  const char* const swept = R"({"alignment": {"kd": {"sweep": [1, 2]}, "kp": {"sweep": [3]}}})";
  baseline.population_sha256 = population_sha256(decode_study(std::string(R"({"controller": )") + swept + "}", {}));
  EXPECT_THAT(refusal(swept, baseline), HasSubstr("this study has sweeps, and the baseline has not"));
  baseline.cells = {{{{"controller.alignment.kd", 2.0}, {"controller.alignment.kp", 3.0}}, {3, 10}},
                    {{{"controller.alignment.kp", 3.0}, {"controller.alignment.kd", 1.0}}, {4, 10}}};
  EXPECT_EQ(refusal(swept, baseline), "") << "in whatever order cells and names are";
  EXPECT_THAT(refusal("{}", baseline), HasSubstr("the baseline has sweeps, and this study has not"));
  EXPECT_THAT(refusal(R"({"alignment": {"kd": {"sweep": [1, 2.5]}, "kp": {"sweep": [3]}}})", baseline),
              HasSubstr("has no cell controller.alignment.kp = 3, controller.alignment.kd = 2.5"));
  EXPECT_THAT(refusal(R"({"alignment": {"kd": {"sweep": [1]}, "kp": {"sweep": [3]}}})", baseline),
              HasSubstr("has 2 cells, and this study 1"));
}

/// A sweep of eta1 over 0.001, 0.002, ... in which so many of the trials of each cell converged.
Summary sweep_of(const std::vector<std::uint64_t>& converged, std::uint64_t trials) {
  Summary summary = made_up_summary({0, 0, 0, 0, 0});
  for (std::size_t i = 0; i < converged.size(); ++i) {
    summary.cells.push_back({{{"controller.contraction.eta1", 0.001 * static_cast<double>(i + 1)}},
                             made_up_statistics({converged[i], trials - converged[i], 0, 0, 0})});
    summary.all.completed += trials;
    summary.all.outcomes[0] += converged[i];
    summary.all.outcomes[1] += trials - converged[i];
  }
  summary.requested = summary.completed = summary.all.completed;
  return summary;
}

TEST(JudgeAgainst, WithSweepsHoldsEachCellAgainstItsOwn) {
  const Baseline baseline = read_baseline(summary_json(sweep_of({9000, 5000, 10000}, 10000)));
  ASSERT_EQ(baseline.cells.size(), 3U);
  Summary summary = sweep_of({9000, 4700, 10000}, 10000);
  judge_against(baseline, {}, summary);
  ASSERT_EQ(summary.gates.size(), 3U);
  EXPECT_EQ(summary.gates[0].verdict, Verdict::pass);
  EXPECT_EQ(summary.gates[1].verdict, Verdict::fail);
  EXPECT_THAT(summary.gates[1].reason, HasSubstr("at level 0.05 over 3 cells"));
  EXPECT_EQ(summary.gates[1].cell.front().value, 0.002);
  EXPECT_EQ(summary.gates[2].verdict, Verdict::pass);
  const Json json = testing::ordered_json_of(summary_json(summary)).at("baseline");
  EXPECT_TRUE(json.at("drop").is_null());
  EXPECT_EQ(json.at("trials"), 30000);
  EXPECT_EQ(json.at("cells").size(), 3U);
  EXPECT_EQ(json.at("cells")[1].at("drop").at("estimate").get<double>(), *summary.gates[1].value);
  EXPECT_EQ(json.at("cells")[1].at("converged"), 5000);
}

TEST(JudgeAgainst, WithSweepsFindsADropAtTheLevelOverTheNumberOfCells) {
  // A drop that is significant at 0.05 and not at 0.05 / 20: among twenty cells it is nothing remarkable.
  const ProportionCount before{5000, 10000};
  const ProportionCount now{4870, 10000};
  ASSERT_GT(proportion_drop(before, now, 0.05).low, 0.0);
  ASSERT_LT(proportion_drop(before, now, 0.05 / 20).low, 0.0);
  EXPECT_EQ(held(before, now).verdict, Verdict::fail);
  std::vector<std::uint64_t> cells(20, 5000);
  const Baseline baseline = read_baseline(summary_json(sweep_of(cells, 10000)));
  cells[7] = now.successes;
  Summary summary = sweep_of(cells, 10000);
  BaselineTest test;
  test.margin = 0.03;
  judge_against(baseline, test, summary);
  EXPECT_EQ(worst_verdict(summary.gates), Verdict::pass);
  EXPECT_EQ(summary.baseline->cells[7].drop->low, proportion_drop(before, now, 0.05 / 20).low);
  EXPECT_EQ(summary.baseline->cells[7].drop->high, proportion_drop(before, now, 0.05).high) << "a pass takes all cells";
}

TEST(JudgeAgainst, OfOneScramblingOfSobolsSequenceIsInconclusive) {
  Summary summary = made_up_summary({5000, 5000, 0, 0, 0});
  summary.all.unit = IntervalUnit::none;
  judge_against(baseline_of(9000, 10000), {}, summary);
  EXPECT_EQ(summary.gates.back().verdict, Verdict::inconclusive);
  EXPECT_THAT(summary.gates.back().reason, HasSubstr("one scrambling of Sobol's sequence tells no limits"));
}

TEST(JudgeAgainst, FailsOnASignificantDropAlone) {
  EXPECT_EQ(held({9000, 10000}, {8800, 10000}).verdict, Verdict::fail);
  EXPECT_EQ(held({9000, 10000}, {8960, 10000}).verdict, Verdict::pass);
  EXPECT_EQ(held({9000, 10000}, {9500, 10000}).verdict, Verdict::pass) << "a rise is no drop";
  EXPECT_EQ(held({90, 100}, {88, 100}).verdict, Verdict::inconclusive) << "too few to tell";
  EXPECT_EQ(held({90, 100}, {50, 100}).verdict, Verdict::fail) << "few are enough for a large drop";
}

TEST(JudgeAgainst, AtNoAndAtAllSuccesses) {
  EXPECT_EQ(held({1000, 1000}, {1000, 1000}).verdict, Verdict::pass);
  EXPECT_EQ(held({1000, 1000}, {0, 1000}).verdict, Verdict::fail);
  EXPECT_EQ(held({0, 1000}, {0, 1000}).verdict, Verdict::pass);
  EXPECT_EQ(held({0, 1000}, {1000, 1000}).verdict, Verdict::pass);
  EXPECT_EQ(held({1, 1}, {0, 1}).verdict, Verdict::inconclusive);
  EXPECT_EQ(held({1, 1}, {1, 1}).verdict, Verdict::inconclusive);
}

TEST(JudgeAgainst, PassesJustWhereTheMarginIsRuledOut) {
  Summary summary = made_up_summary({9000, 1000, 0, 0, 0});
  judge_against(baseline_of(9000, 10000), {}, summary);
  const double high = summary.baseline->drop->high;
  BaselineTest test;
  test.margin = high + 1e-9;
  EXPECT_EQ(held({9000, 10000}, {9000, 10000}, test).verdict, Verdict::pass);
  test.margin = high;
  EXPECT_EQ(held({9000, 10000}, {9000, 10000}, test).verdict, Verdict::inconclusive);
}

TEST(JudgeAgainst, TellsTheDropAndWhatWouldHaveBeenFound) {
  Summary summary = made_up_summary({870, 130, 0, 0, 0});
  judge_against(baseline_of(900, 1000), {}, summary);
  const BaselineComparison& comparison = *summary.baseline;
  EXPECT_NEAR(comparison.drop->estimate, 0.03, 1e-12);
  const std::optional<double> detectable = detectable_drop({900, 1000}, 1000, 0.05, 0.8);
  EXPECT_EQ(comparison.detectable_drop, detectable);
  const GateVerdict& gate = summary.gates.back();
  EXPECT_EQ(gate.metric, "success_rate");
  EXPECT_EQ(gate.expr, "drop < 0.02");
  EXPECT_EQ(gate.value, comparison.drop->estimate);
  EXPECT_EQ(gate.interval, (SampleInterval{comparison.drop->low, comparison.drop->high}));
  const Json json = testing::ordered_json_of(summary_json(summary)).at("baseline");
  EXPECT_EQ(json.at("trials"), 1000);
  EXPECT_EQ(json.at("converged"), 900);
  EXPECT_EQ(json.at("level"), 0.05);
  EXPECT_EQ(json.at("detectable_drop").get<double>(), *detectable);
  EXPECT_EQ(json.at("drop").at("low").get<double>(), comparison.drop->low);
  EXPECT_TRUE(testing::ordered_json_of(summary_json(made_up_summary({7, 3, 0, 0, 0}))).at("baseline").is_null());
}

TEST(JudgeAgainst, OfAnIncompleteRunIsNeverAPass) {
  Summary summary = made_up_summary({9000, 1000, 0, 0, 0});
  summary.complete = false;
  summary.requested = 20000;
  judge_against(baseline_of(9000, 10000), {}, summary);
  EXPECT_EQ(summary.gates.back().verdict, Verdict::inconclusive);
  EXPECT_THAT(summary.gates.back().reason, HasSubstr("only 10,000 of 20,000 trials have finished"));

  Summary nothing = made_up_summary({0, 0, 0, 0, 0});
  nothing.complete = false;
  nothing.requested = 100;
  judge_against(baseline_of(9000, 10000), {}, nothing);
  EXPECT_EQ(nothing.gates.back().verdict, Verdict::inconclusive);
  EXPECT_EQ(nothing.gates.back().reason, "no data; only 0 of 100 trials have finished");
  EXPECT_FALSE(nothing.baseline->drop);

  Summary dropped = made_up_summary({5000, 5000, 0, 0, 0});
  dropped.complete = false;
  judge_against(baseline_of(9000, 10000), {}, dropped);
  EXPECT_EQ(dropped.gates.back().verdict, Verdict::fail);
}

}  // namespace
}  // namespace steerstat
