#include "report/pairing.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sample_comparison.hpp"

namespace steerstat {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using testing_report::drawn_spec;
using testing_report::Finished;
using testing_report::finished;

Pairing pair_up(const Finished& a, const Finished& b) {
  return pair_trials(a.compared(), b.compared(), spec_differences(a.study, b.study));
}

std::vector<std::string> reasons(const Finished& a, const Finished& b) {
  try {
    pair_up(a, b);
  } catch (const StudiesDoNotPair& refused) {
    for (const std::string& reason : refused.reasons()) EXPECT_THAT(refused.what(), HasSubstr(reason));
    return refused.reasons();
  }
  return {};
}

TEST(SpecDifferences, NameEachPlaceWithBothValues) {
  const Study a = decode_study(R"({"controller": {"realignment": "never"}, "plant": {"m1": {"uniform": [1, 2]}}})", {});
  const Study b = decode_study(R"({"horizon": 100, "plant": {"m1": {"uniform": [1, 3]}, "m2": 2}})", {});
  EXPECT_THAT(
      spec_differences(a, b),
      ElementsAre(SpecDifference{"/controller/realignment", "\"never\"", "\"after_cycle\""},
                  SpecDifference{"/horizon", "300", "100"}, SpecDifference{"/plant/m1/uniform", "[1,2]", "[1,3]"},
                  SpecDifference{"/plant/m2", "1", "2"}));
}

TEST(SpecDifferences, LeaveOutWhatDecidesNoOutcome) {
  const Study a = decode_study("{}", {});
  const Study b = decode_study(R"({"name": "other", "audit": {"trials": 3}, "retain": {"trajectories": {"first": 2}},
                                   "sampling": {"trials": 7}})",
                               {});
  EXPECT_THAT(spec_differences(a, b), IsEmpty());
}

TEST(PairTrials, PairsWhatDiffersInControllerNominalPlantFixedValuesGoalHorizonAndIntegrator) {
  const Finished a = finished(drawn_spec(20));
  const Finished b = finished(
      drawn_spec(20, R"(, "controller": {"realignment": "always", "contraction": {"eta2": 0.5}}, "nominal": {"m1": 1.1},
                         "initial_state": {"q1": 2}, "goal": {"q2": 1}, "horizon": 100,
                         "integrator": {"method": "cvode", "tolerance": 1e-8}, "name": "b", "audit": {"trials": 0})"));
  const Pairing pairing = pair_up(a, b);
  EXPECT_THAT(pairing.rows, SizeIs(20));
  EXPECT_THAT(pairing.drawn, ElementsAre("plant.m1", "plant.f2"));
  for (const auto& [row_a, row_b] : pairing.rows) EXPECT_EQ(row_a, row_b);
}

TEST(PairTrials, PairsTheTrialsThatBothHave) {
  Finished a = finished(drawn_spec(20));
  Finished b = finished(drawn_spec(50));
  EXPECT_THAT(pair_up(a, b).rows, SizeIs(20));
  testing_report::keep_trials(a, [](std::uint64_t index) { return index < 4 || index > 15; });
  testing_report::keep_trials(b, [](std::uint64_t index) { return index > 2; });
  EXPECT_THAT(pair_up(a, b).rows,
              ElementsAre(std::pair(3, 0), std::pair(4, 13), std::pair(5, 14), std::pair(6, 15), std::pair(7, 16)));
}

TEST(PairTrials, PairsTheIndependentTrialsOfAStudyOfSobolIndices) {
  const Finished a =
      finished(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "sampling": {"method": "sobol_indices", "trials": 2}})");
  EXPECT_THAT(pair_up(a, a).rows, ElementsAre(std::pair(0, 0), std::pair(1, 1), std::pair(3, 3), std::pair(4, 4)));
}

TEST(PairTrials, PairsSweptStudiesCellByCellWhereverTheSweepsAreTheSame) {
  const std::string sweep = R"(, "controller": {"contraction": {"eta1": {"sweep": [0.3, 0.5]}}})";
  const std::string other = R"(, "controller": {"contraction": {"eta1": {"sweep": [0.3, 0.6]}}})";
  const std::string more = R"(, "controller": {"contraction": {"eta1": {"sweep": [0.3, 0.5, 0.6]}}})";
  EXPECT_THAT(pair_up(finished(drawn_spec(20, sweep)), finished(drawn_spec(30, sweep))).rows, SizeIs(40));
  for (const std::string& b : {other, more, std::string()}) {
    EXPECT_THAT(reasons(finished(drawn_spec(20, sweep)), finished(drawn_spec(20, b))),
                ElementsAre(HasSubstr("the sweeps differ: 2 cells of controller.contraction.eta1 in A")));
  }
}

TEST(PairTrials, PairsSingleCellsWhateverTheySweep) {
  const std::string single = R"(, "controller": {"contraction": {"eta1": {"sweep": [0.3]}}})";
  EXPECT_THAT(pair_up(finished(drawn_spec(20, single)), finished(drawn_spec(20))).rows, SizeIs(20));
}

TEST(PairTrials, RefusesWithEveryReasonAtOnce) {
  const Finished a = finished(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "m2": {"uniform": [1, 2]}, "f1": 0.1},
                                  "sampling": {"trials": 5, "seed": 1}})");
  const Finished b = finished(R"({"plant": {"m1": {"uniform": [0.8, 1.3]}, "f1": {"uniform": [0, 0.1]}},
                                  "controller": {"swing": {"speed": {"sweep": [0.1, 0.2]}}},
                                  "sampling": {"trials": 5, "seed": 2}})");
  EXPECT_THAT(reasons(a, b),
              ElementsAre(AllOf(HasSubstr("/sampling/seed: 1 in A, 2 in B"), HasSubstr("; run both with one")),
                          HasSubstr("/plant/m1/uniform: [0.8,1.2] in A, [0.8,1.3] in B"),
                          HasSubstr("/plant/m2: drawn in A alone"), HasSubstr("/plant/f1: drawn in B alone"),
                          HasSubstr("the sweeps differ: none in A, 2 cells of controller.swing.speed in B")));
}

TEST(PairTrials, PairsExtensibleDesignsOfAnySizeAndLatinHypercubesOfOne) {
  const auto of = [](const char* method, int trials) {
    return finished(fmt::format(R"({{"plant": {{"m1": {{"uniform": [0.8, 1.2]}}, "m2": {{"uniform": [1, 2]}}}},
                                    "sampling": {{"method": "{}", "trials": {}}}}})",
                                method, trials));
  };
  EXPECT_THAT(pair_up(of("sobol", 16), of("sobol", 32)).rows, SizeIs(16));
  EXPECT_THAT(pair_up(of("latin_hypercube", 16), of("latin_hypercube", 16)).rows, SizeIs(16));
  EXPECT_THAT(reasons(of("latin_hypercube", 16), of("latin_hypercube", 32)),
              ElementsAre(HasSubstr("/sampling/trials: 16 in A, 32 in B")));
}

TEST(PairTrials, RefusesOtherCorrelations) {
  const auto of = [](double correlation) {
    return finished(fmt::format(
        R"({{"plant": {{"m1": {{"uniform": [0.8, 1.2]}}, "m2": {{"uniform": [1, 2]}}}},
             "sampling": {{"trials": 8, "correlation": [["plant.m1", "plant.m2", {}]]}}}})",
        correlation));
  };
  EXPECT_THAT(pair_up(of(0.5), of(0.5)).rows, SizeIs(8));
  EXPECT_THAT(reasons(of(0.5), of(0.6)), ElementsAre(HasSubstr("/sampling/correlation: [[")));
}

TEST(PairTrials, RefusesAnotherMethodAndOtherListedInputs) {
  const Finished a = finished(R"({"sampling": {"method": "explicit", "trials": [{"plant.m1": 1.1}]}})");
  const Finished b = finished(R"({"sampling": {"method": "explicit", "trials": [{"plant.m2": 1.1}]}})");
  EXPECT_THAT(reasons(a, b), ElementsAre(HasSubstr("A lists plant.m1, B plant.m2")));
  EXPECT_THAT(reasons(a, finished("{}")), Contains(HasSubstr("/sampling/method: \"explicit\" in A, \"monte_carlo\"")));
}

TEST(PairTrials, RefusesRelativeDrawsOfAnotherNominalPlant) {
  const std::string relative = R"({"plant": {"m1": {"uniform": [0.8, 1.2], "relative": true}})";
  const Finished a = finished(relative + "}");
  EXPECT_THAT(reasons(a, finished(relative + R"(, "nominal": {"m1": 1.1}})")),
              ElementsAre(HasSubstr("/nominal/m1: 1 in A, 1.1 in B (the draws of /plant/m1 are relative to it)")));
  EXPECT_THAT(reasons(a, finished(relative + R"(, "nominal": {"I2": 1.1}})")), IsEmpty());
}

TEST(PairTrials, ComparesListedTrialsByTheirValues) {
  const auto listed = [](const std::string& rows) {
    return finished(R"({"sampling": {"method": "explicit", "trials": [)" + rows + "]}}");
  };
  const Finished a = listed(R"({"plant.m1": 1.1}, {"plant.m1": 1.2})");
  EXPECT_THAT(pair_up(a, listed(R"({"plant.m1": 1.1})")).rows, SizeIs(1));
  EXPECT_THAT(reasons(a, listed(R"({"plant.m1": 1.1}, {"plant.m1": 1.3})")),
              ElementsAre(HasSubstr("plant.m1 of trial 1 is 1.2 in A and 1.3 in B")));
}

TEST(PairTrials, RefusesStoredDrawsThatDifferInOneBit) {
  const Finished a = finished(drawn_spec(20));
  Finished b = a;
  double& stored = b.parameters[1][13];
  stored = std::nextafter(stored, 1.0);
  EXPECT_THAT(reasons(a, b), ElementsAre(HasSubstr("plant.f2 of trial 13 is ")));
  testing_report::keep_trials(b, [](std::uint64_t index) { return index != 13; });
  EXPECT_THAT(reasons(a, b), IsEmpty());
}

TEST(PairTrials, RefusesStudiesWithoutACommonTrial) {
  const Finished a = finished(drawn_spec(20));
  Finished b = a;
  testing_report::keep_trials(b, [](std::uint64_t) { return false; });
  EXPECT_THAT(reasons(a, b), ElementsAre(HasSubstr("no trial has finished in both")));
}

}  // namespace
}  // namespace steerstat
