#include "study/gate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.hpp"
#include "study/rate.hpp"
#include "study/spec_json.hpp"
#include "trial/metric.hpp"

namespace steerstat {
namespace {

using ::testing::HasSubstr;

const char* const sweep_of_two =
    R"("controller": {"contraction": {"eta1": {"sweep": [0.3, 0.5]}, "eta2": {"sweep": [0.4, 0.6]}}})";

TEST(Gates, KnowARateForEveryOutcome) {
  ASSERT_EQ(rate_names().size(), 1 + status_names.size());
  EXPECT_EQ(outcome_of_rate("success_rate"), Status::converged);
  for (const std::string_view status : status_names) {
    EXPECT_EQ(outcome_of_rate(std::string(status) + "_rate"), status_named(status));
  }
  EXPECT_EQ(outcome_of_rate("settling_time"), std::nullopt);
}

TEST(Gates, JudgeEveryMetricAndEveryQuantityThatItHas) {
  std::string list;
  std::size_t count = 0;
  const auto add = [&](std::string_view metric, std::string_view quantity) {
    list += std::string(list.empty() ? "" : ",") + R"({"metric": ")" + std::string(metric) + R"(", "expr": ")" +
            std::string(quantity) + R"( < 0.5"})";
    ++count;
  };
  for (const std::string_view rate : rate_names()) {
    for (const std::string_view quantity : rate_quantities()) add(rate, quantity);
  }
  EXPECT_EQ(decode_study(R"({"gates": [)" + list + "]}", {}).gates.size(), count);
  for (const Metric& metric : metrics()) {
    list.clear();
    for (const std::string_view quantity : sample_quantities()) add(metric.name, quantity);
    const Study study = decode_study(R"({"gates": [)" + list + "]}", {});
    ASSERT_EQ(study.gates.size(), sample_quantities().size());
    EXPECT_EQ(study.gates.front().metric, metric.name);
  }
}

TEST(Gates, AreTheSameHoweverTheyAreWritten) {
  const std::string spec = std::string("{") + sweep_of_two;
  const Study one = decode_study(spec + R"(, "gates": [{"metric": "settling_time", "expr": "120>p95",
      "cell": {"controller.contraction.eta2": 0.6, "controller.contraction.eta1": 0.3}}]})",
                                 {});
  const Study other = decode_study(spec + R"(, "gates": [{"expr": "p95 < 120.0", "metric": "settling_time",
      "cell": {"controller.contraction.eta1": 0.3, "controller.contraction.eta2": 0.6}}]})",
                                   {});
  EXPECT_EQ(one, other);
  EXPECT_EQ(spec_sha256(one), spec_sha256(other));
  const Study over_all = decode_study(R"({"gates": [{"metric": "cycles", "expr": "max < 9", "scope": "all"}]})", {});
  EXPECT_EQ(over_all, decode_study(R"({"gates": [{"metric": "cycles", "expr": "max < 9"}]})", {}));
}

TEST(Gates, LeaveTheIdentityOfAStudyWithoutThemAsItWas) {
  const Study plain = decode_study("{}", {});
  EXPECT_EQ(plain, decode_study(R"({"gates": [], "baseline": {}})", {}));
  EXPECT_EQ(canonical_spec(plain).find("gates"), std::string::npos);
  EXPECT_EQ(canonical_spec(plain).find("baseline"), std::string::npos);
  EXPECT_NE(spec_sha256(plain), spec_sha256(decode_study(R"({"baseline": {"level": 0.01}})", {})));
}

TEST(Population, IsOfThePlantTheStartTheGoalTheHorizonAndWhatCountsAsSuccess) {
  const auto population = [](const char* spec) { return population_sha256(decode_study(spec, {})); };
  const std::string plain = population("{}");
  for (const char* same :
       {R"({"name": "other", "sampling": {"trials": 50, "seed": 9}})", R"({"controller": {"alignment": {"kd": 1}}})",
        R"({"integrator": {"method": "cvode"}, "audit": {"trials": 0}, "retain": {"trajectories": {"first": 1}},
           "metrics": false})",
        R"({"gates": [{"metric": "success_rate", "expr": "ci_low > 0.5"}], "baseline": {"level": 0.01}})"}) {
    EXPECT_EQ(population(same), plain) << same;
  }
  for (const char* other :
       {R"({"plant": {"m1": 1.1}})", R"({"plant": {"f2": {"uniform": [0, 0.05]}}})", R"({"nominal": {"m1": 1.1}})",
        R"({"initial_state": {"q1": 2}})", R"({"goal": {"q2": 0.5}})", R"({"horizon": 200})",
        R"({"controller": {"convergence": {"tolerance": 0.01}}})",
        R"({"sampling": {"method": "explicit", "trials": [{"plant.m1": 1.1}]}})"}) {
    EXPECT_NE(population(other), plain) << other;
  }
}

}  // namespace
}  // namespace steerstat
