#include "report/approximation_summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "json_text.hpp"
#include "study/approximation_json.hpp"

namespace steerstat {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

ApproximationStudy study_of(const std::string& cycle, std::uint64_t draws) {
  ApproximationStudy study = decode_approximation(R"({"kind": "approximation", "cycle": )" + cycle + "}");
  study.draws = draws;
  return study;
}

/// Errors that follow |A|^p T^q, but for a factor of each draw's own.
std::vector<CycleError> power_law(const ApproximationStudy& study, double p, double q) {
  const CyclePlan plan(study);
  std::vector<CycleError> errors;
  for (std::uint64_t cell = 0; cell < plan.cells(); ++cell) {
    for (std::uint64_t draw = 0; draw < plan.draws(); ++draw) {
      const Cycle cycle = plan.cycle(draw, cell);
      const double error = cycle.q2 * std::pow(std::abs(cycle.amplitude), p) * std::pow(cycle.period, q);
      errors.push_back({{error, error, error}, {error, error, error}, error, error});
    }
  }
  return errors;
}

TEST(SummariseApproximation, FindsTheOrdersOfAPowerLaw) {
  const ApproximationStudy study =
      study_of(R"({"amplitude": {"sweep": [-10, 20, 50]}, "period": {"sweep": [1, 2, 8]}})", 20);
  for (const ApproximationSummary::Orders& orders : summarise(study, power_law(study, 2.0, -1.5)).orders) {
    EXPECT_NEAR(orders.amplitude->mean, 2.0, 1e-12);
    EXPECT_NEAR(orders.period->mean, -1.5, 1e-12);
    EXPECT_NEAR(orders.dilation->mean, 2.5, 1e-12);
    EXPECT_NEAR(*orders.amplitude->standard_error, 0.0, 1e-12);
    EXPECT_EQ(orders.amplitude->draws, 20U);
  }
}

TEST(SummariseApproximation, HasNoOrderWhereAnInputHasOneSize) {
  const ApproximationStudy study = study_of(R"({"amplitude": {"sweep": [-10, 10]}, "period": {"sweep": [1, 2]}})", 5);
  const ApproximationSummary summary = summarise(study, power_law(study, 2.0, 3.0));
  EXPECT_FALSE(summary.orders[0].amplitude);
  EXPECT_TRUE(summary.orders[0].period);
  EXPECT_FALSE(summary.orders[0].dilation);
}

TEST(SummariseApproximation, LeavesDrawsWithoutErrorOutOfTheOrders) {
  const ApproximationStudy study = study_of(R"({"amplitude": {"sweep": [10, 20]}})", 5);
  std::vector<CycleError> errors = power_law(study, 2.0, 0.0);
  errors[3].end.position = 0.0;
  EXPECT_EQ(summarise(study, errors).orders[0].amplitude->draws, 4U);
  for (CycleError& error : errors) error.end.position = 0.0;
  EXPECT_FALSE(summarise(study, errors).orders[0].amplitude);
}

TEST(SummariseApproximation, TheStandardErrorIsThatOfTheDrawsMean) {
  const ApproximationStudy study = study_of(R"({"amplitude": {"sweep": [1, 2]}})", 4);
  std::vector<CycleError> errors = power_law(study, 0.0, 0.0);
  for (std::size_t draw = 0; draw < 4; ++draw) {  // slopes 0, 1, 2, 3: standard deviation sqrt(5/3)
    errors[4 + draw].end.velocity = errors[draw].end.velocity * std::exp2(static_cast<double>(draw));
  }
  const FittedOrder order = *summarise(study, errors).orders[1].amplitude;
  EXPECT_NEAR(order.mean, 1.5, 1e-12);
  EXPECT_NEAR(*order.standard_error, std::sqrt(5.0 / 3.0) / 2.0, 1e-12);
  EXPECT_NEAR(order.p50, 1.5, 1e-12);
}

TEST(ApproximationSummary, IsShownAsASquareAsAListAndAsJson) {
  const ApproximationStudy square =
      study_of(R"({"amplitude": {"sweep": [10, 20]}, "period": {"sweep": [1, 2, 4]}})", 3);
  const ApproximationSummary in_square = summarise(square, power_law(square, 2.0, -1.0));
  EXPECT_THAT(approximation_text(in_square, false), HasSubstr("T = 4 s"));
  EXPECT_THAT(approximation_text(in_square, false), HasSubstr("2.00 ± 0.00"));
  const ApproximationStudy list = study_of(R"({"q2_dot": {"sweep": [0.1, 0.2]}})", 3);
  const ApproximationSummary in_list = summarise(list, power_law(list, 2.0, -1.0));
  EXPECT_THAT(approximation_text(in_list, false), HasSubstr("cycle.q2_dot"));
  EXPECT_THAT(approximation_text(in_list, false), Not(HasSubstr("Fitted order")));
  const auto json = testing::json_of(approximation_json(in_list));
  EXPECT_EQ(json.at("cells").at(1).at("sweep").at("cycle.q2_dot"), 0.2);
  EXPECT_TRUE(json.at("orders").at("velocity_step").at("amplitude").is_null());
}

}  // namespace
}  // namespace steerstat
