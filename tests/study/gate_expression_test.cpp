#include "study/gate_expression.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace steerstat {
namespace {

std::string parsed(std::string_view text) {
  const auto result = parse_gate_expression(text);
  if (const auto* expression = std::get_if<GateExpression>(&result)) return expression_text(*expression);
  const auto& error = std::get<GateSyntaxError>(result);
  return "at " + std::to_string(error.position) + " \"" + error.found + "\" is not " + error.wanted;
}

TEST(GateExpression, IsAQuantityAComparisonAndANumber) {
  EXPECT_EQ(parsed("ci_low >= 0.99"), "ci_low >= 0.99");
  EXPECT_EQ(parsed("p95<120"), "p95 < 120");
  EXPECT_EQ(parsed("  mean\t<=\n-1.5e-3 "), "mean <= -0.0015");
  EXPECT_EQ(parsed("max > 1E3"), "max > 1000");
  EXPECT_EQ(parsed("count >= 0"), "count >= 0");
  EXPECT_EQ(parsed("count >= -0"), "count >= 0") << "written and read alike";
  for (const std::string_view quantity : quantity_names) {
    for (const std::string_view relation : relation_names) {
      const std::string text = std::string(quantity) + ' ' + std::string(relation) + " 0.125";
      EXPECT_EQ(parsed(text), text);
    }
  }
}

TEST(GateExpression, TakesTheNumberFirstToo) {
  EXPECT_EQ(parsed("0.99 <= ci_low"), "ci_low >= 0.99");
  EXPECT_EQ(parsed("0.99 < ci_low"), "ci_low > 0.99");
  EXPECT_EQ(parsed("120>p95"), "p95 < 120");
  EXPECT_EQ(parsed("120 >= p95"), "p95 <= 120");
}

TEST(GateExpression, TellsWhereItStopsMakingSense) {
  EXPECT_EQ(parsed(""), "at 1 \"\" is not a quantity");
  EXPECT_EQ(parsed("   "), "at 4 \"\" is not a quantity");
  EXPECT_EQ(parsed("p96 < 1"), "at 1 \"p96\" is not a quantity");
  EXPECT_EQ(parsed("p95"), "at 4 \"\" is not <, <=, > or >=");
  EXPECT_EQ(parsed("p95 = 3"), "at 5 \"=\" is not <, <=, > or >=");
  EXPECT_EQ(parsed("p95 => 3"), "at 5 \"=>\" is not <, <=, > or >=");
  EXPECT_EQ(parsed("p95 \u2264 3"), "at 5 \"\u2264\" is not <, <=, > or >=");
  EXPECT_EQ(parsed("p95 <"), "at 6 \"\" is not a number");
  EXPECT_EQ(parsed("p95 < p99"), "at 7 \"p99\" is not a number");
  EXPECT_EQ(parsed("p95 < .5"), "at 7 \".5\" is not a number");
  EXPECT_EQ(parsed("p95 < 5."), "at 7 \"5.\" is not a number");
  EXPECT_EQ(parsed("p95 < 5.e3"), "at 7 \"5.e3\" is not a number");
  EXPECT_EQ(parsed("p95 < +5"), "at 7 \"+5\" is not a number");
  EXPECT_EQ(parsed("p95 < 1e"), "at 7 \"1e\" is not a number");
  EXPECT_EQ(parsed("p95 < 0x10"), "at 7 \"0x10\" is not a number");
  EXPECT_EQ(parsed("p95 < inf"), "at 7 \"inf\" is not a number");
  EXPECT_EQ(parsed("p95 < -inf"), "at 7 \"-inf\" is not a number");
  EXPECT_EQ(parsed("p95 < nan"), "at 7 \"nan\" is not a number");
  EXPECT_EQ(parsed("p95 < 1e999"), "at 7 \"1e999\" is not a number that a double holds");
  EXPECT_EQ(parsed("p95 < 120 s"), "at 11 \"s\" is not the end of the expression");
  EXPECT_EQ(parsed("ci_low >= 99 %"), "at 14 \"%\" is not the end of the expression");
  EXPECT_EQ(parsed("1 < p95 < 2"), "at 9 \"<\" is not the end of the expression");
  EXPECT_EQ(parsed("1 < 2"), "at 5 \"2\" is not a quantity");
  EXPECT_EQ(parsed("1"), "at 2 \"\" is not <, <=, > or >=");
  EXPECT_EQ(parsed("CI_LOW > 1"), "at 1 \"CI_LOW\" is not a quantity");
  EXPECT_EQ(parsed("é > 1"), "at 1 \"é\" is not a quantity") << "characters are counted, not bytes";
  EXPECT_EQ(parsed("p95 é 1"), "at 5 \"é\" is not <, <=, > or >=");
  EXPECT_EQ(parsed(std::string_view("p95\0< 1", 7)), std::string("at 4 \"") + '\0' + "\" is not <, <=, > or >=");
}

TEST(GateExpression, ReadsItsOwnTextBackToTheSameBits) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 10000; ++i) {
    const double bound = std::ldexp(static_cast<double>(random()), static_cast<int>(random() % 200) - 164);
    const GateExpression expression{static_cast<Quantity>(random() % quantity_names.size()),
                                    static_cast<Relation>(random() % 4), random() % 2 == 0 ? bound : -bound};
    const auto again = parse_gate_expression(expression_text(expression));
    ASSERT_TRUE(std::holds_alternative<GateExpression>(again)) << expression_text(expression);
    EXPECT_EQ(std::get<GateExpression>(again), expression) << expression_text(expression);
  }
}

TEST(GateExpression, AnyTextIsParsedOrRefusedAtAPlaceInIt) {
  std::mt19937_64 random(11);
  const std::string letters = "p95ci_lowmean<>=!.-+e0 1\xC3\xA9\xFF";
  for (int i = 0; i < 20000; ++i) {
    std::string text(random() % 16, ' ');
    for (char& c : text) c = letters[random() % letters.size()];
    const auto result = parse_gate_expression(text);
    if (const auto* error = std::get_if<GateSyntaxError>(&result)) {
      EXPECT_GE(error->position, 1U);
      EXPECT_LE(error->position, text.size() + 1);
      EXPECT_NE(text.find(error->found), std::string::npos);
    }
  }
}

TEST(GateExpression, ComparesStrictlyOrNotAtTheBound) {
  const auto holds = [](Relation relation, double x) { return GateExpression{Quantity::mean, relation, 2.0}.holds(x); };
  const double below = std::nextafter(2.0, 0.0);
  const double above = std::nextafter(2.0, 3.0);
  EXPECT_TRUE(holds(Relation::less, below) && !holds(Relation::less, 2.0) && !holds(Relation::less, above));
  EXPECT_TRUE(holds(Relation::less_equal, 2.0) && !holds(Relation::less_equal, above));
  EXPECT_TRUE(holds(Relation::greater, above) && !holds(Relation::greater, 2.0) && !holds(Relation::greater, below));
  EXPECT_TRUE(holds(Relation::greater_equal, 2.0) && !holds(Relation::greater_equal, below));
}

}  // namespace
}  // namespace steerstat
