#include "report/sensitivity.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "json_text.hpp"
#include "report/summary.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

/// The study, run by a rule that says how a trial of these parameters ends.
StudyResult run_by(const Study& study, const std::function<TrialOutcome(const TrialParameters&)>& rule) {
  const Plan plan(study);
  StudyResult result;
  for (std::uint64_t index = 0; index < plan.trials(); ++index) {
    result.trials.index.push_back(index);
    result.trials.outcomes.push_back(rule(plan.parameters(index)));
  }
  result.complete = true;
  return result;
}

std::vector<std::vector<double>> columns_of(const Study& study, const StudyResult& result) {
  const Plan plan(study);
  std::vector<std::vector<double>> columns(plan.varying().size());
  std::vector<double> values(columns.size());
  for (const std::uint64_t index : result.trials.index) {
    plan.draw(index, values);
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i].push_back(values[i]);
  }
  return columns;
}

TrialOutcome ended(Status status, double end_time) {
  TrialOutcome outcome;
  outcome.status = status;
  outcome.end_time = end_time;
  return outcome;
}

/// Converges above m1 = 1, later the more f1; else times out. m2 does not matter.
TrialOutcome cliff_in_m1(const TrialParameters& p) {
  return p.plant.m1 > 1.0 ? ended(Status::converged, 50.0 + 1000.0 * p.plant.f1) : ended(Status::timeout, 300.0);
}

Study indices_study(std::uint64_t rows) {
  return decode_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "m2": {"uniform": [0.8, 1.2]},
                                    "f1": {"uniform": [0, 0.05]}},
                          "sampling": {"method": "sobol_indices", "trials": )" +
                          std::to_string(rows) + "}}",
                      {});
}

GivenDataSensitivity given_data_of(const Study& study, const StudyResult& result,
                                   const std::vector<std::string_view>& names) {
  std::vector<Metric> outputs;
  for (const std::string_view name : names) outputs.push_back(*find_output(name));
  return given_data_sensitivity(study, result, columns_of(study, result), outputs);
}

TEST(FindOutput, KnowsSuccessEndTimeAndEveryMetric) {
  EXPECT_EQ(find_output("success")->value(ended(Status::converged, 3.0)), 1.0);
  EXPECT_EQ(find_output("success")->value(ended(Status::diverged, 3.0)), 0.0);
  EXPECT_EQ(find_output("end_time")->value(ended(Status::timeout, 300.0)), 300.0);
  for (const Metric& metric : metrics()) EXPECT_EQ(find_output(metric.name)->value, metric.value);
  for (const std::string_view name : output_names()) EXPECT_TRUE(find_output(name)) << name;
  EXPECT_EQ(output_names().size(), metric_count + 2);
  EXPECT_FALSE(find_output("succes"));
}

TEST(SobolSensitivity, FindsTheInputThatDecides) {
  const Study study = indices_study(400);
  const StudyResult result = run_by(study, cliff_in_m1);
  const auto sobol = sobol_sensitivity(study, Plan(study), result.trials);
  ASSERT_TRUE(sobol);
  EXPECT_THAT(sobol->inputs, ElementsAre("plant.m1", "plant.m2", "plant.f1"));
  EXPECT_EQ(sobol->independent_trials, 800U);
  ASSERT_EQ(sobol->outputs.size(), 3U);
  EXPECT_EQ(sobol->outputs[0].name, "success");
  EXPECT_EQ(sobol->outputs[0].rows, 400U);
  const std::vector<SobolIndices>& success = *sobol->outputs[0].indices;
  EXPECT_NEAR(success[0].first_order.estimate, 1.0, 1e-12);
  EXPECT_NEAR(success[0].total.estimate, 1.0, 4.0 / std::sqrt(400.0));
  EXPECT_EQ(success[1].total.estimate, 0.0);
  EXPECT_EQ(success[2].total.estimate, 0.0);
}

TEST(SobolSensitivity, TakesSettlingTimesFromRowsThatConvergeThroughoutAndEndTimesFromAll) {
  const Study study = indices_study(1000);
  const StudyResult result = run_by(study, cliff_in_m1);
  const auto sobol = sobol_sensitivity(study, Plan(study), result.trials);
  EXPECT_EQ(sobol->outputs[1].name, "settling_time");
  EXPECT_NEAR(static_cast<double>(sobol->outputs[1].rows), 250.0, 4.0 * std::sqrt(1000.0 * 0.25 * 0.75));
  EXPECT_NEAR((*sobol->outputs[1].indices)[2].first_order.estimate, 1.0, 1e-12);
  EXPECT_EQ((*sobol->outputs[1].indices)[0].total.estimate, 0.0);
  EXPECT_EQ(sobol->outputs[2].name, "end_time");
  EXPECT_EQ(sobol->outputs[2].rows, 1000U);
  EXPECT_GT((*sobol->outputs[2].indices)[0].first_order.low, 0.9);
}

TEST(SobolSensitivity, CountsARowOnlyWhenAllOfItHasFinished) {
  const Study study = indices_study(100);
  StudyResult result = run_by(study, cliff_in_m1);
  // Rows are five trials: 0 and 2 lose one each, 1 and 3 run into one another, 4 loses its first.
  const std::vector<std::uint64_t> lost{1, 9, 10, 13, 15, 20};
  for (auto i = lost.rbegin(); i != lost.rend(); ++i) {
    result.trials.index.erase(result.trials.index.begin() + static_cast<std::ptrdiff_t>(*i));
    result.trials.outcomes.erase(result.trials.outcomes.begin() + static_cast<std::ptrdiff_t>(*i));
  }
  const auto sobol = sobol_sensitivity(study, Plan(study), result.trials);
  EXPECT_EQ(sobol->outputs[0].rows, 95U);
  EXPECT_EQ(sobol->independent_trials, 200U - 4U);  // 1, 10, 15 and 20
}

TEST(SobolSensitivity, IsOfNoOtherSampling) {
  const Study study = decode_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}})", {});
  EXPECT_FALSE(sobol_sensitivity(study, Plan(study), TrialTable{}));
}

TEST(Summarise, CountsOnlyTheIndependentTrialsOfAPickFreezeDesign) {
  const Study study = indices_study(100);
  const StudyResult result = run_by(study, cliff_in_m1);
  const Summary summary = summarise(study, result);
  EXPECT_EQ(summary.requested, 500U);
  EXPECT_EQ(summary.completed, 500U);
  EXPECT_EQ(summary.all.completed, 200U);
  std::uint64_t converged = 0;
  for (std::size_t i = 0; i < 500; ++i) {
    if (i % 5 < 2 && result.trials.outcomes[i].status == Status::converged) ++converged;
  }
  EXPECT_EQ(summary.all.outcomes[0], converged);
  EXPECT_EQ(summary.all.success_rate->estimate, static_cast<double>(converged) / 200.0);
  ASSERT_TRUE(summary.sensitivity);
  const Json json = testing::ordered_json_of(summary_json(summary));
  EXPECT_EQ(json["trials"]["completed"], 500);
  EXPECT_EQ(json["sensitivity"]["independent_trials"], 200);
  EXPECT_EQ(json["sensitivity"]["rows"]["success"], 100);
  EXPECT_EQ(json["sensitivity"]["success"][0]["input"], "plant.m1");
  EXPECT_EQ(json["sensitivity"]["success"][1]["total"], 0.0);
  EXPECT_EQ(json["sensitivity"]["settling_time"][0]["first_order"], nullptr);  // too few rows
  EXPECT_THAT(summary_text(summary, false), HasSubstr("Of the 200 trials that are independent"));
}

TEST(GivenDataSensitivity, FindsTheInputThatDecides) {
  const Study study = decode_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f1": {"uniform": [0, 0.05]}},
                                       "sampling": {"trials": 2000}})",
                                   {});
  const auto given = given_data_of(study, run_by(study, cliff_in_m1), {"success", "settling_time"});
  EXPECT_FALSE(given.exact);
  EXPECT_EQ(given.outputs[0].trials, 2000U);
  EXPECT_GT(given.outputs[0].indices[0]->estimate, 0.98);
  EXPECT_LT(given.outputs[0].indices[1]->low, 0.0);
  EXPECT_NEAR(static_cast<double>(given.outputs[1].trials), 1000.0, 4.0 * std::sqrt(500.0));
  EXPECT_GT(given.outputs[1].indices[1]->estimate, 0.98);
  EXPECT_LT(given.outputs[1].indices[0]->low, 0.0);
}

TEST(GivenDataSensitivity, UsesTheIndependentTrialsOfAPickFreezeDesign) {
  const Study study = indices_study(100);
  const auto given = given_data_of(study, run_by(study, cliff_in_m1), {"success"});
  EXPECT_EQ(given.outputs[0].trials, 200U);
}

TEST(GivenDataSensitivity, TakesTheTrialsOfADrawInAllCellsTogether) {
  // Every cell of a draw ends alike: five cells must not make the draws' chance look like five times the evidence.
  const auto rule = [](const TrialParameters& p) {
    return std::fmod(1e6 * p.plant.m1, 1.0) > 0.5 ? ended(Status::converged, 50.0) : ended(Status::timeout, 300.0);
  };
  const std::string head = R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "m2": {"uniform": [0.8, 1.2]}},)";
  const std::string tail = R"("sampling": {"trials": 200}})";
  const Study one = decode_study(head + tail, {});
  const Study five = decode_study(
      head + R"("controller": {"contraction": {"eta1": {"sweep": [0.3, 0.4, 0.5, 0.6, 0.7]}}},)" + tail, {});
  const auto of_one = given_data_of(one, run_by(one, rule), {"success"});
  const auto of_five = given_data_of(five, run_by(five, rule), {"success"});
  EXPECT_EQ(of_five.outputs[0].trials, 1000U);
  EXPECT_NEAR(of_five.outputs[0].indices[1]->estimate, of_one.outputs[0].indices[1]->estimate, 1e-12);
  EXPECT_NEAR(of_five.outputs[0].indices[1]->high, of_one.outputs[0].indices[1]->high, 1e-12);
  EXPECT_NEAR(of_five.outputs[0].indices[2]->estimate, 0.0, 1e-12);  // the swept eta1
}

TEST(GivenDataSensitivity, IsExactForACompleteGridAndSaysNothingOfHalfOfOne) {
  const Study study = decode_study(R"({"plant": {"m1": {"sweep": [0.9, 1.1]}, "f1": {"sweep": [0, 0.01, 0.02]}},
                                       "sampling": {"method": "grid"}})",
                                   {});
  StudyResult result = run_by(study, cliff_in_m1);
  const auto whole = given_data_of(study, result, {"success", "settling_time"});
  EXPECT_TRUE(whole.exact);
  EXPECT_EQ(*whole.outputs[0].indices[0], (SensitivityIndex{1.0, 1.0, 1.0}));
  EXPECT_EQ(*whole.outputs[0].indices[1], (SensitivityIndex{0.0, 0.0, 0.0}));
  EXPECT_EQ(whole.outputs[1].indices[1]->estimate, 1.0);
  result.complete = false;
  result.trials.index.pop_back();
  result.trials.outcomes.pop_back();
  const auto half = given_data_of(study, result, {"success"});
  EXPECT_FALSE(half.exact);
  EXPECT_FALSE(half.outputs[0].indices[0]);
}

SensitivityReport report_of(const Study& study, const StudyResult& result) {
  return {"0123456789abcdef", "sample", result.complete, given_data_of(study, result, {"success", "settling_time"}),
          sobol_sensitivity(study, Plan(study), result.trials)};
}

TEST(SensitivityJson, HasBothKindsOfIndices) {
  const Study study = indices_study(100);
  const SensitivityReport report = report_of(study, run_by(study, cliff_in_m1));
  const Json json = testing::ordered_json_of(sensitivity_json(report));
  EXPECT_EQ(json["study"]["id"], "0123456789abcdef");
  EXPECT_EQ(json["given_data"]["outputs"][0]["metric"], "success");
  EXPECT_EQ(json["given_data"]["outputs"][0]["trials"], 200);
  EXPECT_EQ(json["given_data"]["outputs"][0]["inputs"][0]["first_order"].get<double>(),
            report.given_data.outputs[0].indices[0]->estimate);
  EXPECT_EQ(json["sobol_indices"]["success"][0]["total_ci_high"].get<double>(),
            (*report.sobol->outputs[0].indices)[0].total.high);
}

TEST(SensitivityText, RanksInputsAndSaysWhatHasNoIndices) {
  const Study study = indices_study(100);
  const std::string text = sensitivity_text(report_of(study, run_by(study, cliff_in_m1)), false);
  EXPECT_LT(text.find("plant.m1"), text.find("plant.m2"));
  EXPECT_THAT(text, HasSubstr("settling_time  no indices: "));
  EXPECT_THAT(text, HasSubstr("of 100 rows\n"));
  EXPECT_THAT(text, HasSubstr("of 200 trials\n"));
  const Study nothing = decode_study("{}", {});
  EXPECT_THAT(sensitivity_text(report_of(nothing, run_by(nothing, cliff_in_m1)), false),
              HasSubstr("Nothing varies in this study."));
}

}  // namespace
}  // namespace steerstat
