#include "report/rare_failures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <variant>
#include <vector>

#include "core/errors.hpp"
#include "report/baseline.hpp"
#include "report/comparison.hpp"
#include "report/pairing.hpp"
#include "report/summary.hpp"
#include "study/run.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

// The paper's cliff: trials fail where friction on the passive joint exceeds about 0.0247.
std::string cliff(const std::string& sampling, const std::string& more = "") {
  return R"({"plant": {"f2": {"uniform": [0, 0.0249]}, "m1": {"lognormal": {"median": 1, "sigma": 0.001}}},
             "metrics": false, "audit": {"trials": 0}, "sampling": )" +
         sampling + more + "}";
}

constexpr const char* towards_the_cliff =
    R"({"method": "importance", "trials": 3000, "seed": 5, "proposal": {"nominal": 0.2,
        "components": [{"inputs": {"plant.f2": {"shift": 2.5, "scale": 0.5}}}]}})";

Summary summary_of(const std::string& spec) {
  const Study study = decode_study(spec, {});
  return summarise(study, run_study(study, {}));
}

/// Plain trials to count failures in; tests/run nightly asks for many.
double plain_trials() {
  const char* const asked = std::getenv("STEERSTAT_RARE_TRIALS");  // NOLINT(concurrency-mt-unsafe): nothing sets it
  return asked == nullptr ? 12'000.0 : std::stod(asked);
}

TEST(RareFailures, AgreeWithPlainTrialsAndTellMore) {
  const double trials = plain_trials();
  const Summary plain = summary_of(cliff(R"({"seed": 6, "trials": )" + std::to_string(std::llround(trials)) + "}"));
  const Summary weighted = summary_of(cliff(towards_the_cliff));
  ASSERT_TRUE(weighted.rare_failures);
  const WeightedFailures& found = std::get<WeightedFailures>(weighted.rare_failures->found);
  EXPECT_TRUE(found.trusted) << found.reason;
  const double p = 1.0 - plain.all.success_rate->estimate;
  ASSERT_GT(p, 0.0);
  const double error = std::hypot(found.standard_error, std::sqrt(p * (1.0 - p) / trials));
  EXPECT_NEAR(found.estimate, p, 4.0 * error);
  EXPECT_GT(equivalent_trials(*weighted.rare_failures), 12'000.0);  // for 3,000
}

TEST(RareFailures, AreTheSuccessRateOfTheSummaryAndOfItsGates) {
  const Summary summary =
      summary_of(cliff(towards_the_cliff, R"(, "gates": [{"metric": "success_rate", "expr": "ci_low >= 0.5"},
                                                          {"metric": "success_rate", "expr": "ci_low >= 0.9999"}])"));
  const WeightedFailures& found = std::get<WeightedFailures>(summary.rare_failures->found);
  ASSERT_TRUE(summary.all.success_rate);
  EXPECT_EQ(summary.all.success_rate->estimate, 1.0 - found.estimate);
  EXPECT_EQ(summary.all.success_rate->low, 1.0 - found.high);
  EXPECT_EQ(summary.gates[0].interval.low, 1.0 - found.high);
  EXPECT_EQ(summary.gates[0].verdict, Verdict::pass);
  EXPECT_EQ(summary.gates[1].verdict, Verdict::fail);
  for (const auto& metric : summary.all.metrics) EXPECT_FALSE(metric);
}

TEST(RareFailures, AreThoseOfTheNominalDrawsWhereNoTrialFails) {
  const Summary summary = summary_of(
      R"({"plant": {"m1": {"uniform": [0.99, 1.01]}}, "audit": {"trials": 0},
          "sampling": {"method": "importance", "trials": 50}})");
  const WeightedFailures& found = std::get<WeightedFailures>(summary.rare_failures->found);
  EXPECT_FALSE(found.trusted);
  EXPECT_EQ(interval_method(*summary.rare_failures), "clopper_pearson");
  EXPECT_EQ(summary.all.success_rate->high, 1.0);
  const auto nominal = static_cast<double>(found.nominal.trials);
  EXPECT_NEAR(summary.all.success_rate->low, std::pow(0.025, 1.0 / nominal), 1e-12);
  EXPECT_EQ(summary.all.effective_trials, nominal);
}

TEST(RareFailures, AreOfStudiesThatSeekThemAlone) {
  EXPECT_FALSE(summary_of(R"({"sampling": {"trials": 2}})").rare_failures);
}

TEST(RareFailures, CompareWithNothingThatCountsTrials) {
  const Study study = decode_study(cliff(towards_the_cliff), {});
  EXPECT_THROW(require_same_population(study, {}), BadUsage);
  const StudyResult result;
  const std::vector<std::vector<double>> parameters;
  const ComparedStudy side{study, result, parameters, ""};
  try {
    compare(side, side);
    FAIL() << "compared";
  } catch (const StudiesDoNotPair& refused) {
    EXPECT_NE(std::string(refused.what()).find("drawn where failures are"), std::string::npos) << refused.what();
  }
}

}  // namespace
}  // namespace steerstat
