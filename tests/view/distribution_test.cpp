#include "view/distribution.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "statistics/distribution_band.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

using ::testing::ElementsAre;

EmpiricalDistribution of(std::vector<double> values) {
  return empirical_distribution("settling_time", "s", std::move(values), "", 0.95);
}

TEST(EmpiricalDistribution, HasEveryValueWhereThereAreFewAndCountsTiesTogether) {
  const EmpiricalDistribution distribution = of({3.0, 1.0, 2.0, 2.0});
  EXPECT_THAT(distribution.x, ElementsAre(1.0, 2.0, 3.0));
  EXPECT_THAT(distribution.f, ElementsAre(0.25, 0.75, 1.0));
  EXPECT_EQ(distribution.trials, 4U);
}

TEST(EmpiricalDistribution, IsTheShareAtOrBelowEachPointHoweverManyValuesThereAre) {
  std::mt19937_64 generator(1);
  std::geometric_distribution<int> ties(0.1);
  std::normal_distribution<double> normal;
  for (const bool tied : {true, false}) {
    std::vector<double> values;
    for (int i = 0; i < 5000; ++i) values.push_back(tied ? ties(generator) : normal(generator));
    const EmpiricalDistribution distribution = of(values);
    EXPECT_LE(distribution.x.size(), most_distribution_points);
    EXPECT_TRUE(std::is_sorted(distribution.x.begin(), distribution.x.end()));
    std::sort(values.begin(), values.end());
    EXPECT_EQ(distribution.x.front(), values.front());
    EXPECT_EQ(distribution.x.back(), values.back());
    for (std::size_t k = 0; k < distribution.x.size(); ++k) {
      const auto below = std::upper_bound(values.begin(), values.end(), distribution.x[k]) - values.begin();
      EXPECT_EQ(distribution.f[k], static_cast<double>(below) / 5000.0);
    }
  }
}

TEST(EmpiricalDistribution, LeavesOutNothingAt400ValuesAndThinsAt401) {
  std::vector<double> values(most_distribution_points);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
  EXPECT_EQ(of(values).x.size(), most_distribution_points);
  values.push_back(1e3);
  EXPECT_EQ(of(values).x.size(), most_distribution_points);
  EXPECT_EQ(of(values).x.back(), 1e3);
}

TEST(EmpiricalDistribution, HasTheBandOfItsTrialsOrSaysWhyNot) {
  const EmpiricalDistribution banded = of({1.0, 2.0, 4.0});
  ASSERT_TRUE(banded.band);
  EXPECT_EQ(banded.band->half_width, distribution_band(3, 0.95));
  EXPECT_EQ(banded.band_note, "");
  EXPECT_FALSE(of({}).band);
  EXPECT_EQ(of({}).band_note, "there are no trials");
  EXPECT_TRUE(of({}).x.empty());
  const auto grid = empirical_distribution("cycles", "1", {1.0}, "the trials are not drawn", 0.95);
  EXPECT_FALSE(grid.band);
  EXPECT_EQ(grid.band_note, "the trials are not drawn");
}

TEST(ObstacleToBand, IsWhateverMakesTrialsDependent) {
  const auto obstacle = [](const char* spec, std::uint64_t cells) {
    return obstacle_to_band(decode_study(spec, {}), cells);
  };
  EXPECT_EQ(obstacle(R"({"sampling": {"trials": 10}})", 1), "");
  EXPECT_NE(obstacle(R"({"sampling": {"trials": 10}})", 2), "");
  for (const char* method : {"sobol", "latin_hypercube"}) {
    const std::string spec =
        std::string(R"({"plant": {"m1": {"uniform": [1, 2]}}, "sampling": {"trials": 16, "method": ")") + method +
        "\"}}";
    EXPECT_NE(obstacle(spec.c_str(), 1), "") << method;
  }
  EXPECT_NE(obstacle(R"({"plant": {"m1": {"sweep": [1]}}, "sampling": {"method": "grid"}})", 1), "");
  EXPECT_NE(obstacle(R"({"plant": {"m1": {"uniform": [1, 2]}}, "sampling": {"trials": 5000},
                         "stop": {"until": [{"metric": "success_rate", "half_width": 0.1}]}})",
                     1),
            "");
}

}  // namespace
}  // namespace steerstat
