#include "trial/metric.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>

namespace steerstat {
namespace {

double value_of(const char* name, const TrialOutcome& outcome) {
  return find_metric(name)->value(outcome);
}

TEST(Metrics, HaveNamesOfTheirOwnThatFindThem) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < metrics().size(); ++i) {
    const Metric& metric = metrics()[i];
    EXPECT_TRUE(names.insert(metric.name).second) << metric.name;
    EXPECT_EQ(find_metric(metric.name), &metric);
    EXPECT_EQ(metric_index(metric.name), i);
    EXPECT_FALSE(metric.unit.empty()) << metric.name;
  }
  EXPECT_EQ(names.size(), metric_count);
}

TEST(Metrics, AreNotFoundByOtherNames) {
  EXPECT_EQ(find_metric("settling"), nullptr);
  EXPECT_EQ(find_metric(""), nullptr);
  EXPECT_THROW((void)metric_index("Effort"), std::invalid_argument);
}

TEST(Metrics, SettlingTimeAndCyclesAreTheConvergedTrialsAlone) {
  TrialOutcome outcome;
  outcome.end_time = 12.5;
  outcome.cycles = 7;
  outcome.status = Status::converged;
  EXPECT_EQ(value_of("settling_time", outcome), 12.5);
  EXPECT_EQ(value_of("cycles", outcome), 7.0);
  outcome.status = Status::timeout;
  EXPECT_TRUE(std::isnan(value_of("settling_time", outcome)));
  EXPECT_TRUE(std::isnan(value_of("cycles", outcome)));
}

TEST(Metrics, OfTheCourseAreTheOutcomesOwnFieldsHoweverItEnded) {
  TrialOutcome outcome;
  outcome.status = Status::timeout;
  outcome.effort = 1.0;
  outcome.peak_acceleration = 2.0;
  outcome.peak_force = 3.0;
  outcome.peak_stroke = 4.0;
  outcome.position_contraction = {5.0, 6.0};
  outcome.velocity_contraction = {7.0, -8.0};
  EXPECT_EQ(value_of("effort", outcome), 1.0);
  EXPECT_EQ(value_of("peak_acceleration", outcome), 2.0);
  EXPECT_EQ(value_of("peak_force", outcome), 3.0);
  EXPECT_EQ(value_of("peak_stroke", outcome), 4.0);
  EXPECT_EQ(value_of("position_contraction_mean", outcome), 5.0);
  EXPECT_EQ(value_of("position_contraction_worst", outcome), 6.0);
  EXPECT_EQ(value_of("velocity_contraction_mean", outcome), 7.0);
  EXPECT_EQ(value_of("velocity_contraction_worst", outcome), -8.0);
}

TEST(Metrics, AreNoneWhereTheOutcomeHasNoneOrNoFiniteOne) {
  TrialOutcome outcome;
  for (const Metric& metric : metrics()) EXPECT_TRUE(std::isnan(metric.value(outcome))) << metric.name;
  outcome.effort = outcome.peak_force = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isnan(value_of("effort", outcome)));
  EXPECT_TRUE(std::isnan(value_of("peak_force", outcome)));
}

TEST(SameBits, TellsEveryFieldApartAndANanFromNothing) {
  const TrialOutcome none;
  EXPECT_TRUE(same_bits(none, none));
  TrialOutcome other;
  for (double* field : {&other.effort, &other.peak_acceleration, &other.peak_force, &other.peak_stroke,
                        &other.position_contraction.mean, &other.position_contraction.worst,
                        &other.velocity_contraction.mean, &other.velocity_contraction.worst}) {
    const double before = *field;
    *field = 1.0;
    EXPECT_FALSE(same_bits(none, other));
    *field = before;
  }
  EXPECT_TRUE(same_bits(none, other));
}

}  // namespace
}  // namespace steerstat
