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
  EXPECT_THAT(mistakes_in(summary_json(made_up_sweep(3))), HasSubstr("/cells: a study with sweeps"));
}

TEST(Baseline, MustBeOfThePopulationThatTheStudyIsOf) {
  const Study study = decode_study(R"({"name": "here", "controller": {"alignment": {"kd": 1}}})", {});
  Baseline baseline = baseline_of(7, 10);
  baseline.population_sha256 = population_sha256(decode_study(R"({"sampling": {"trials": 9}})", {}));
  EXPECT_NO_THROW(require_same_population(study, baseline));
  baseline.population_sha256 = population_sha256(decode_study(R"({"goal": {"q2": 0.5}})", {}));
  EXPECT_THROW(require_same_population(study, baseline), BadUsage);
  const Study swept = decode_study(R"({"controller": {"alignment": {"kd": {"sweep": [1, 2]}}}})", {});
  baseline.population_sha256 = population_sha256(swept);
  EXPECT_THROW(require_same_population(swept, baseline), BadUsage);
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
