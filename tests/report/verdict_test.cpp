#include "report/verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "study/gate_expression.hpp"

namespace steerstat {
namespace {

using ::testing::HasSubstr;

GateExpression expression(const char* text) {
  return std::get<GateExpression>(parse_gate_expression(text));
}

Verdict verdict(const char* text, const Evidence& evidence, std::string_view shortfall = "") {
  return judge(expression(text), evidence, shortfall).verdict;
}

constexpr Evidence around_half{0.5, {0.4, 0.6}};

TEST(Verdict, OfAnEstimateIsThatOfItsWholeInterval) {
  for (const char* quantity : {"estimate", "mean", "p05", "p50", "p95", "p99"}) {
    const auto of = [&](const char* rest) { return verdict((std::string(quantity) + rest).c_str(), around_half); };
    EXPECT_EQ(of(" >= 0.4"), Verdict::pass) << "the interval's ends belong to it";
    EXPECT_EQ(of(" > 0.4"), Verdict::inconclusive);
    EXPECT_EQ(of(" > 0.39"), Verdict::pass);
    EXPECT_EQ(of(" >= 0.5"), Verdict::inconclusive) << "whatever side the estimate is on";
    EXPECT_EQ(of(" >= 0.6"), Verdict::inconclusive);
    EXPECT_EQ(of(" > 0.6"), Verdict::fail);
    EXPECT_EQ(of(" >= 0.61"), Verdict::fail);
    EXPECT_EQ(of(" <= 0.6"), Verdict::pass);
    EXPECT_EQ(of(" < 0.6"), Verdict::inconclusive);
    EXPECT_EQ(of(" < 0.61"), Verdict::pass);
    EXPECT_EQ(of(" <= 0.4"), Verdict::inconclusive);
    EXPECT_EQ(of(" < 0.4"), Verdict::fail);
    EXPECT_EQ(of(" <= 0.39"), Verdict::fail);
  }
}

TEST(Verdict, OfTheBoundThatMustHoldIsThatOfTheInterval) {
  const Evidence low{0.4, {0.4, 0.6}};
  const Evidence high{0.6, {0.4, 0.6}};
  for (const char* rest : {">= 0.39", ">= 0.4", "> 0.4", "> 0.5", ">= 0.6", "> 0.6", ">= 0.61"}) {
    EXPECT_EQ(verdict((std::string("ci_low ") + rest).c_str(), low),
              verdict((std::string("estimate ") + rest).c_str(), around_half))
        << rest;
  }
  for (const char* rest : {"<= 0.61", "<= 0.6", "< 0.6", "< 0.5", "<= 0.4", "< 0.4", "<= 0.39"}) {
    EXPECT_EQ(verdict((std::string("ci_high ") + rest).c_str(), high),
              verdict((std::string("estimate ") + rest).c_str(), around_half))
        << rest;
  }
}

TEST(Verdict, OfTheOtherBoundIsDefinite) {
  const Evidence low{0.4, {0.4, 0.6}};
  EXPECT_EQ(verdict("ci_low <= 0.4", low), Verdict::pass);
  EXPECT_EQ(verdict("ci_low < 0.4", low), Verdict::fail);
  const Evidence high{0.6, {0.4, 0.6}};
  EXPECT_EQ(verdict("ci_high >= 0.6", high), Verdict::pass);
  EXPECT_EQ(verdict("ci_high > 0.6", high), Verdict::fail);
}

TEST(Verdict, OfMinMaxAndCountIsExact) {
  for (const char* quantity : {"min", "max", "count"}) {
    const auto of = [&](const char* rest) { return verdict((std::string(quantity) + rest).c_str(), {7.0, {}}); };
    EXPECT_EQ(of(" >= 7"), Verdict::pass);
    EXPECT_EQ(of(" > 7"), Verdict::fail);
    EXPECT_EQ(of(" <= 7"), Verdict::pass);
    EXPECT_EQ(of(" < 7"), Verdict::fail);
  }
}

TEST(Verdict, WithoutDataIsInconclusive) {
  const Judgement judgement = judge(expression("p95 < 120"), {}, "");
  EXPECT_EQ(judgement.verdict, Verdict::inconclusive);
  EXPECT_EQ(judgement.reason, "no data");
  EXPECT_EQ(verdict("count >= 1", {0.0, {}}), Verdict::fail) << "no trials are a count too";
}

TEST(Verdict, NeedsOnlyTheBoundThatDecides) {
  const Evidence open_above{90.0, {60.0, std::nullopt}};
  EXPECT_EQ(verdict("p95 < 120", open_above), Verdict::inconclusive);
  EXPECT_EQ(verdict("p95 < 60", open_above), Verdict::fail);
  EXPECT_EQ(verdict("p95 > 50", open_above), Verdict::pass);
  EXPECT_EQ(verdict("p95 > 70", open_above), Verdict::inconclusive);
  EXPECT_THAT(judge(expression("p95 < 120"), open_above, "").reason,
              HasSubstr("too few trials for the interval, 60 to unbounded above; run more"));
  const Evidence single{90.0, {}};
  EXPECT_EQ(verdict("mean < 1e9", single), Verdict::inconclusive);
}

TEST(Verdict, OfAnIncompleteStudyIsNeverAPass) {
  const char* const shortfall = "only 20 of 100 trials have finished";
  EXPECT_EQ(verdict("estimate > 0.3", around_half, shortfall), Verdict::inconclusive);
  EXPECT_EQ(verdict("count >= 20", {20.0, {}}, shortfall), Verdict::inconclusive);
  EXPECT_EQ(verdict("max < 8", {7.0, {}}, shortfall), Verdict::inconclusive);
  const Judgement judgement = judge(expression("ci_low > 0.3"), {0.4, {0.4, 0.6}}, shortfall);
  EXPECT_EQ(judgement.verdict, Verdict::inconclusive);
  EXPECT_EQ(judgement.reason, "would pass (all of the interval, 0.4 to 0.6), but only 20 of 100 trials have finished");
}

TEST(Verdict, OfAnIncompleteStudyIsAFailWhereMoreTrialsCannotUndoIt) {
  const char* const shortfall = "only 20 of 100 trials have finished";
  EXPECT_EQ(verdict("estimate > 0.7", around_half, shortfall), Verdict::fail);
  EXPECT_EQ(verdict("ci_low < 0.3", {0.4, {0.4, 0.6}}, shortfall), Verdict::fail);
  EXPECT_EQ(verdict("max < 6", {7.0, {}}, shortfall), Verdict::fail) << "a maximum only grows";
  EXPECT_EQ(verdict("max > 8", {7.0, {}}, shortfall), Verdict::inconclusive);
  EXPECT_EQ(verdict("min > 8", {7.0, {}}, shortfall), Verdict::fail) << "a minimum only falls";
  EXPECT_EQ(verdict("min < 6", {7.0, {}}, shortfall), Verdict::inconclusive);
  EXPECT_EQ(verdict("count < 6", {7.0, {}}, shortfall), Verdict::fail) << "a count only grows";
  EXPECT_EQ(verdict("count >= 8", {7.0, {}}, shortfall), Verdict::inconclusive);
}

TEST(Verdict, OfAllIsTheWorst) {
  GateVerdict pass;
  pass.verdict = Verdict::pass;
  GateVerdict fail;
  fail.verdict = Verdict::fail;
  const GateVerdict inconclusive;
  EXPECT_EQ(worst_verdict({}), Verdict::pass);
  EXPECT_EQ(worst_verdict({pass, pass}), Verdict::pass);
  EXPECT_EQ(worst_verdict({pass, inconclusive}), Verdict::inconclusive);
  EXPECT_EQ(worst_verdict({inconclusive, fail, pass}), Verdict::fail);
}

}  // namespace
}  // namespace steerstat
