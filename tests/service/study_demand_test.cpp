#include "service/study_demand.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "study/spec_json.hpp"

namespace steerstat {
namespace {

constexpr std::uint64_t memory = 1000;

StudyDemand asking(std::uint64_t trials, std::uint64_t bytes) {
  return {trials, bytes, 0};
}

std::optional<std::size_t> chosen(const std::vector<WaitingStudy>& queue, const std::vector<StudyDemand>& running,
                                  const ServiceLimits& limits = {}) {
  return next_to_begin(queue, running, limits, memory);
}

TEST(NextToBegin, IsTheFirstWhereThereIsRoom) {
  EXPECT_EQ(chosen({}, {}), std::nullopt);
  EXPECT_EQ(chosen({{asking(10, 1), 0}, {asking(10, 1), 0}}, {}), 0U);
}

TEST(NextToBegin, IsOneThatFitsIntoTheMemoryBeforeOneThatDoesNot) {
  const std::vector<StudyDemand> running{asking(10, 600)};
  EXPECT_EQ(chosen({{asking(10, 400), 0}, {asking(10, 1), 0}}, running), 0U);
  EXPECT_EQ(chosen({{asking(10, 401), 0}, {asking(10, 1), 0}}, running), 1U);
}

TEST(NextToBegin, IsNoneThatComesAfterOneWhichWasOvertakenOftenEnough) {
  const std::vector<StudyDemand> running{asking(10, 600)};
  const std::vector<WaitingStudy> queue{{asking(10, 401), most_overtaken - 1}, {asking(10, 1), 0}};
  EXPECT_EQ(chosen(queue, running), 1U);
  EXPECT_EQ(chosen({{asking(10, 401), most_overtaken}, {asking(10, 1), 0}}, running), std::nullopt);
}

TEST(NextToBegin, NeedingMoreThanThereIsForAllRunsAlone) {
  EXPECT_EQ(chosen({{asking(10, 5000), 0}}, {}), 0U);
  EXPECT_EQ(chosen({{asking(10, 5000), 0}}, {asking(10, 1)}), std::nullopt);
}

TEST(NextToBegin, LeavesPlacesToSmallStudies) {
  ServiceLimits limits;
  limits.running_studies = 3;
  limits.places_for_small = 1;
  limits.small_study = 100;
  const StudyDemand small = asking(100, 1);
  const StudyDemand large = asking(101, 1);
  EXPECT_EQ(chosen({{large, 0}}, {large}, limits), 0U);
  EXPECT_EQ(chosen({{large, 0}}, {large, large}, limits), std::nullopt);
  EXPECT_EQ(chosen({{large, 0}, {small, 0}}, {large, large}, limits), 1U);
  EXPECT_EQ(chosen({{small, 0}}, {large, large, small}, limits), std::nullopt) << "no place is left";
  EXPECT_EQ(chosen({{large, 0}}, {small, small}, limits), 0U);
}

TEST(NextToBegin, OfALargeStudyHasAPlaceWhereEveryPlaceIsForSmallOnes) {
  ServiceLimits limits;
  limits.running_studies = 1;
  limits.places_for_small = 2;
  limits.small_study = 100;
  EXPECT_EQ(chosen({{asking(101, 1), 0}}, {}, limits), 0U);
}

TEST(Demand, GrowsWithTrialsParametersAndTrajectories) {
  const auto demand = [](const char* spec) { return demand_of(decode_study(spec, {})); };
  const StudyDemand plain = demand(R"({"sampling": {"trials": 1000}})");
  EXPECT_EQ(plain.trials, 1000U);
  EXPECT_GT(plain.memory, 1000 * sizeof(TrialOutcome));
  EXPECT_EQ(demand(R"({"sampling": {"trials": 2000}})").memory, 2 * plain.memory);
  EXPECT_GT(demand(R"({"sampling": {"trials": 1000}, "plant": {"m1": {"uniform": [0.8, 1.2]}}})").disk, plain.disk);
  const char* const swept = R"({"sampling": {"trials": 1000}, "plant": {"m1": {"sweep": [1, 2, 3]}}})";
  EXPECT_EQ(demand(swept).trials, 3000U);
  const char* const retaining = R"({"sampling": {"trials": 1000}, "retain": {"trajectories": {"first": 1000}}})";
  EXPECT_GT(demand(retaining).memory, plain.memory + 1000 * 500'000U);
}

}  // namespace
}  // namespace steerstat
