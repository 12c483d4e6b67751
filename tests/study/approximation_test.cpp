#include "study/approximation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/errors.hpp"
#include "study/approximation_json.hpp"

namespace steerstat {
namespace {

namespace fs = std::filesystem;

std::string approximation_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<fs::path> approximation_specs(const std::string& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(STEERSTAT_SOURCE_DIR "/tests/study/approximation_corpus/" + folder)) {
    if (entry.path().extension() == ".json") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  EXPECT_FALSE(paths.empty());
  return paths;
}

std::string mistakes_in(const std::string& text) {
  try {
    decode_approximation(text);
  } catch (const BadSpec& bad) {
    return bad.what() + std::string("\n");
  }
  return "";
}

TEST(DecodeApproximation, TakesTheGoodSpecs) {
  for (const fs::path& path : approximation_specs("good")) EXPECT_EQ(mistakes_in(approximation_text(path)), "") << path;
}

TEST(DecodeApproximation, RefusesTheBadSpecsWithExactlyTheseErrors) {
  for (fs::path path : approximation_specs("bad")) {
    const std::string mistakes = mistakes_in(approximation_text(path));
    EXPECT_NE(mistakes, "") << path;
    EXPECT_EQ(mistakes, approximation_text(path.replace_extension(".errors"))) << path;
  }
}

TEST(DecodeApproximation, RefusesMoreCyclesThanItsCapAndTakesAsMany) {
  const auto spec = [](const char* trials) {
    return std::string(
               R"({"kind": "approximation", "cycle": {"period": {"sweep": [1, 2, 3, 4]}}, "sampling": {"trials": )") +
           trials + "}}";
  };
  EXPECT_EQ(mistakes_in(spec("500000")), "");
  EXPECT_THAT(mistakes_in(spec("500001")), ::testing::HasSubstr("500001 trials in 4 cells make too many cycles"));
}

TEST(DecodeAnyStudy, TellsTheKindsApart) {
  EXPECT_TRUE(std::holds_alternative<Study>(decode_any_study("{}", {})));
  EXPECT_TRUE(std::holds_alternative<Study>(decode_any_study(R"({"kind": "stabilisation"})", {})));
  EXPECT_TRUE(std::holds_alternative<ApproximationStudy>(decode_any_study(R"({"kind": "approximation"})", {})));
  EXPECT_THROW(decode_any_study(R"({"kind": "approximations"})", {}), BadSpec);
  EXPECT_THROW(decode_any_study("[]", {}), BadSpec);
}

ApproximationStudy swept_cycles(std::uint64_t draws) {
  ApproximationStudy study = decode_approximation(
      R"({"kind": "approximation", "cycle": {"amplitude": {"sweep": [25, 50]}, "period": {"sweep": [1, 2, 4]}}})");
  study.draws = draws;
  return study;
}

TEST(CyclePlan, CellsAreTheFactorialOfTheSweepsAndShareTheirDraws) {
  const CyclePlan plan(swept_cycles(10));
  ASSERT_EQ(plan.cells(), 6U);
  EXPECT_EQ(plan.cycle(3, 4).amplitude, 50.0);
  EXPECT_EQ(plan.cycle(3, 4).period, 2.0);
  EXPECT_EQ(plan.swept(CycleInput::period, 5), 4.0);
  EXPECT_EQ(plan.swept(CycleInput::q2, 5), std::nullopt);
  for (std::uint64_t cell = 1; cell < 6; ++cell) EXPECT_EQ(plan.cycle(7, cell).q2, plan.cycle(7, 0).q2);
  EXPECT_NE(plan.cycle(7, 0).q2, plan.cycle(8, 0).q2);
}

TEST(RunApproximation, MoreDrawsBeginWithTheFewer) {
  const std::vector<CycleError> few = run_approximation(swept_cycles(5));
  const std::vector<CycleError> many = run_approximation(swept_cycles(8));
  ASSERT_EQ(few.size(), 30U);
  for (std::size_t cell = 0; cell < 6; ++cell) {
    for (std::size_t draw = 0; draw < 5; ++draw) EXPECT_EQ(few[cell * 5 + draw], many[cell * 8 + draw]);
  }
}

}  // namespace
}  // namespace steerstat
