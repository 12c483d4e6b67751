#include <gtest/gtest.h>

#include "json_text.hpp"
#include "sample_summary.hpp"

namespace steerstat {
namespace {

using namespace testing_report;
using Json = nlohmann::ordered_json;

std::vector<std::string> keys_of(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

Json json_of(const Summary& summary) {
  return testing::ordered_json_of(summary_json(summary));
}

const std::vector<std::string> statistics_keys{"mean", "std", "min", "p05", "p50", "p95", "p99", "max"};
const std::vector<std::string> sample_keys = [] {
  std::vector<std::string> keys = statistics_keys;
  keys.emplace_back("count");
  return keys;
}();

std::vector<std::string> with_metrics(std::vector<std::string> before, const std::vector<std::string>& after) {
  for (const Metric& metric : metrics()) before.emplace_back(metric.name);
  before.insert(before.end(), after.begin(), after.end());
  return before;
}

TEST(SummaryJson, HasTheInterfacesKeysInItsOrder) {
  const Json json = json_of(made_up_sweep(2));
  EXPECT_EQ(keys_of(json), with_metrics({"study", "complete", "trials", "success_rate", "outcomes"},
                                        {"stop", "cells", "sensitivity", "rare_failures", "gates", "baseline", "audit",
                                         "performance"}));
  EXPECT_EQ(keys_of(json["study"]),
            (std::vector<std::string>{"id", "name", "spec_sha256", "population_sha256", "engine_version", "seed"}));
  EXPECT_EQ(keys_of(json["trials"]), (std::vector<std::string>{"requested", "completed"}));
  EXPECT_EQ(keys_of(json["success_rate"]),
            (std::vector<std::string>{"estimate", "ci_low", "ci_high", "level", "method", "unit", "effective_trials"}));
  EXPECT_EQ(keys_of(json["outcomes"]),
            (std::vector<std::string>{"converged", "timeout", "singular", "diverged", "integrator_failed"}));
  for (const Metric& metric : metrics()) EXPECT_EQ(keys_of(json[std::string(metric.name)]), sample_keys) << metric.name;
  EXPECT_EQ(keys_of(json["cells"][0]), with_metrics({"sweep", "trials", "success_rate", "outcomes"}, {}));
  EXPECT_EQ(keys_of(json["performance"]), (std::vector<std::string>{"wall_s", "trials_per_s", "threads", "simd"}));
}

TEST(SummaryJson, HoldsTheSummarysValuesToTheBit) {
  const Summary summary = made_up_summary({7, 2, 1, 0, 0});
  const Json json = json_of(summary);
  EXPECT_EQ(json["study"]["seed"], 7);
  EXPECT_EQ(json["trials"]["completed"], 10);
  EXPECT_EQ(json["success_rate"]["estimate"].get<double>(), 0.7);
  EXPECT_EQ(json["success_rate"]["ci_low"].get<double>(), summary.all.success_rate->low);
  EXPECT_EQ(json["success_rate"]["ci_high"].get<double>(), summary.all.success_rate->high);
  EXPECT_EQ(json["success_rate"]["method"], "wilson");
  EXPECT_EQ(json["outcomes"]["singular"], 1);
  EXPECT_EQ(json["settling_time"]["mean"].get<double>(), 40.0);
  EXPECT_EQ(json["settling_time"]["std"].get<double>(), *summary.all.of("settling_time")->std);
  EXPECT_EQ(json["settling_time"]["p99"].get<double>(), summary.all.of("settling_time")->p99);
  EXPECT_EQ(json["cycles"]["max"].get<double>(), 7.0);
  EXPECT_EQ(json["cycles"]["count"], 7);
  EXPECT_EQ(json["gates"], Json::array());
  EXPECT_TRUE(json["audit"].is_null());
  EXPECT_EQ(json["performance"]["trials_per_s"].get<double>(), 2.5);
}

TEST(SummaryJson, TellsWhereTheStudyStoppedAndHowPreciseItWasThere) {
  Summary summary = made_up_summary({90, 10, 0, 0, 0});
  EXPECT_TRUE(json_of(summary)["stop"].is_null());
  Summary::Stop& stop = summary.stop.emplace();
  stop.rule = {50, 10, 0.9, {{"success_rate", std::nullopt, 0.1, false}, {"settling_time", 0.95, 0.2, true}}};
  stop.report = {
      100, 6, StopReason::precision_reached, {{0, 0.9, 0.82, 0.95, true}, {0, 40.0, 36.0, std::nullopt, false}}};
  const Json json = json_of(summary)["stop"];
  EXPECT_EQ(keys_of(json), (std::vector<std::string>{"reason", "trials", "looks", "level", "until"}));
  EXPECT_EQ(json["reason"], "precision_reached");
  EXPECT_EQ(json["trials"], 100);
  EXPECT_EQ(json["looks"], 6);
  EXPECT_EQ(json["level"], 0.9);
  EXPECT_EQ(json["until"][0],
            testing::ordered_json_of(R"({"metric": "success_rate", "quantile": null, "half_width": 0.1,
      "reached": true, "cell": null, "estimate": 0.9, "ci_low": 0.82, "ci_high": 0.95})"));
  EXPECT_EQ(json["until"][1],
            testing::ordered_json_of(R"({"metric": "settling_time", "quantile": 0.95, "relative_half_width": 0.2,
      "reached": false, "cell": null, "estimate": 40.0, "ci_low": 36.0, "ci_high": null})"));
  stop.report.reason.reset();
  EXPECT_TRUE(json_of(summary)["stop"]["reason"].is_null());
}

TEST(SummaryJson, TellsWhatTheAuditFound) {
  Summary summary = made_up_summary({7, 3, 0, 0, 0});
  summary.audit = AuditStatistics{5, 3, {2, 9}, AuditStatistics::Difference{1e-8, 2e-8, 3e-8}, 1e-11};
  const Json audit = json_of(summary)["audit"];
  EXPECT_EQ(keys_of(audit),
            (std::vector<std::string>{"trials", "agree", "disagree", "settling_time_difference", "tolerance"}));
  EXPECT_EQ(audit["trials"], 5);
  EXPECT_EQ(audit["agree"], 3);
  EXPECT_EQ(audit["disagree"], Json::array({2, 9}));
  EXPECT_EQ(audit["settling_time_difference"], Json({{"median", 1e-8}, {"p99", 2e-8}, {"max", 3e-8}}));
  EXPECT_EQ(audit["tolerance"].get<double>(), 1e-11);

  summary.audit->settling_time_difference.reset();
  summary.audit->disagree.clear();
  EXPECT_TRUE(json_of(summary)["audit"]["settling_time_difference"].is_null());
  EXPECT_EQ(json_of(summary)["audit"]["disagree"], Json::array());
}

TEST(SummaryJson, NamesTheInstructionSetOfLockstepAlone) {
  Summary summary = made_up_summary({1, 0, 0, 0, 0});
  EXPECT_EQ(json_of(summary)["performance"]["simd"], "avx512");
  summary.simd.reset();
  EXPECT_TRUE(json_of(summary)["performance"]["simd"].is_null());
}

TEST(SummaryJson, KeepsSeedsAndCountsOfSixtyFourBits) {
  Summary summary = made_up_summary({1, 0, 0, 0, 0});
  summary.seed = 18446744073709551615ULL;
  EXPECT_EQ(json_of(summary)["study"]["seed"].get<std::uint64_t>(), summary.seed);
}

TEST(SummaryJson, IsNullWhereThereIsNoData) {
  Summary summary = made_up_summary({});
  summary.wall_s = 0.0;
  const Json json = json_of(summary);
  for (const char* key : {"estimate", "ci_low", "ci_high"}) EXPECT_TRUE(json["success_rate"][key].is_null()) << key;
  EXPECT_EQ(json["success_rate"]["level"], 0.95);
  for (const Metric& metric : metrics()) {
    const Json& sample = json[std::string(metric.name)];
    for (const std::string& key : statistics_keys) EXPECT_TRUE(sample[key].is_null()) << metric.name << ' ' << key;
    EXPECT_EQ(sample["count"], 0) << metric.name;
  }
  EXPECT_TRUE(json["performance"]["trials_per_s"].is_null());
}

TEST(SummaryJson, HasNoSpreadForASingleTrial) {
  const Json json = json_of(made_up_summary({1, 4, 0, 0, 0}));
  EXPECT_TRUE(json["settling_time"]["std"].is_null());
  EXPECT_EQ(json["settling_time"]["mean"], 10.0);
}

TEST(SummaryJson, GivesEveryCellItsSweptValuesAndItsShareOfTheTrials) {
  const Json json = json_of(made_up_sweep(30));
  ASSERT_EQ(json["cells"].size(), 30U);
  EXPECT_EQ(json["cells"][7]["sweep"]["controller.contraction.eta1"].get<double>(), 0.007);
  EXPECT_EQ(json["cells"][7]["trials"]["requested"], 10);
  EXPECT_EQ(json["cells"][7]["success_rate"]["estimate"], 0.7);
  EXPECT_EQ(json["cells"][7]["outcomes"]["timeout"], 3);
}

TEST(SummaryJson, SurvivesANameThatIsNotUtf8) {
  Summary summary = made_up_summary({1, 0, 0, 0, 0});
  summary.name = "a\xff";
  EXPECT_EQ(json_of(summary)["study"]["name"], "a\uFFFD");
}

TEST(SummaryJson, EndsInALine) {
  EXPECT_EQ(summary_json(made_up_summary({})).back(), '\n');
}

}  // namespace
}  // namespace steerstat
