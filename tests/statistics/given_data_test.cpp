#include "statistics/given_data.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "known_sensitivities.hpp"

namespace steerstat {
namespace {

using namespace testing_statistics;

struct Sample {
  std::vector<std::vector<double>> x;  // (inputs x trials)
  std::vector<double> y;
  std::vector<std::uint64_t> unit;
};

Sample sample_of(const KnownSensitivities& known, std::size_t trials, std::uint64_t seed) {
  Draws draws(seed);
  Sample sample;
  sample.x.resize(known.inputs());
  for (std::size_t trial = 0; trial < trials; ++trial) {
    const std::vector<double> u = draws.point(known.inputs());
    for (std::size_t i = 0; i < u.size(); ++i) sample.x[i].push_back(u[i]);
    sample.y.push_back(known.function(u));
    sample.unit.push_back(trial);
  }
  return sample;
}

void expect_within_standard_errors(const KnownSensitivities& known, std::size_t trials) {
  const Sample sample = sample_of(known, trials, 8);
  const GivenData given(sample.y, sample.unit, {0.9999, 1});
  for (std::size_t i = 0; i < known.inputs(); ++i) {
    const auto index = given.first_order(sample.x[i]);
    ASSERT_TRUE(index) << i;
    EXPECT_LE(index->low, known.first_order[i]) << i;
    EXPECT_GE(index->high, known.first_order[i]) << i;
    EXPECT_LT(index->high - index->low, 8.0 * 1.3 / std::sqrt(static_cast<double>(trials))) << i;
  }
}

TEST(GivenData, MeetsTheClosedFormsOfTheIshigamiFunction) {
  for (const std::size_t trials : {1000U, 10'000U}) expect_within_standard_errors(ishigami(), trials);
}

TEST(GivenData, MeetsTheClosedFormsOfTheGFunction) {
  for (const std::size_t trials : {1000U, 10'000U}) expect_within_standard_errors(g_function(), trials);
}

TEST(GivenData, MeetsTheClosedFormsOfASuccessBehindTwoCliffs) {
  for (const std::size_t trials : {1000U, 10'000U}) expect_within_standard_errors(cliffs(), trials);
}

TEST(GivenData, HasNoMoreBiasThanAFourthOfAStandardErrorOnSmoothFunctions) {
  const KnownSensitivities known = ishigami();
  std::vector<Simulation> indices(known.inputs());
  for (std::uint64_t repeat = 0; repeat < 100; ++repeat) {
    const Sample sample = sample_of(known, 1000, repeat);
    const GivenData given(sample.y, sample.unit, {});
    for (std::size_t i = 0; i < known.inputs(); ++i) {
      indices[i].add(*given.first_order(sample.x[i]), known.first_order[i]);
    }
  }
  for (std::size_t i = 0; i < known.inputs(); ++i) {
    const double allowed = indices[i].spread() / 4.0 + 4.0 * indices[i].standard_error_of_mean();
    EXPECT_NEAR(indices[i].mean(), known.first_order[i], allowed) << i;
  }
}

TEST(GivenData, IntervalsCoverAtTheirLevelAndAreNotMuchTooWide) {
  constexpr std::size_t repeats = 150;
  for (const KnownSensitivities& known : {ishigami(), cliffs()}) {
    std::vector<Simulation> indices(known.inputs());
    for (std::uint64_t repeat = 0; repeat < repeats; ++repeat) {
      const Sample sample = sample_of(known, 300, repeat);
      const GivenData given(sample.y, sample.unit, {0.95, repeat});
      for (std::size_t i = 0; i < known.inputs(); ++i) {
        indices[i].add(*given.first_order(sample.x[i]), known.first_order[i]);
      }
    }
    for (std::size_t i = 0; i < known.inputs(); ++i) {
      EXPECT_GE(indices[i].coverage(), least_coverage(repeats)) << i;
      // At most half as wide again: small bins make resamples vary more, most where the index is 0.
      EXPECT_GT(indices[i].claimed() / indices[i].spread(), 0.85) << i;
      EXPECT_LT(indices[i].claimed() / indices[i].spread(), 1.6) << i;
    }
  }
}

TEST(GivenData, IsFarMorePreciseThanTheRankEstimatorForAnInputWithoutEffect) {
  const KnownSensitivities known = ishigami();
  Simulation ours;
  for (std::uint64_t repeat = 0; repeat < 100; ++repeat) {
    const Sample sample = sample_of(known, 1000, repeat);
    ours.add(*GivenData(sample.y, sample.unit, {}).first_order(sample.x[3]), 0.0);
  }
  EXPECT_LT(ours.spread(), 0.7 / std::sqrt(1000.0));  // the rank estimator's is 1 / sqrt(n) [Chatterjee 2021]
}

TEST(GivenData, TakesEachValueOfADiscreteInputAsABin) {
  // y = x plus noise of the variance of x, x one of three values.
  Draws draws(2);
  std::vector<double> x, y;
  std::vector<std::uint64_t> unit(6000);
  std::iota(unit.begin(), unit.end(), 0U);
  for (std::size_t i = 0; i < unit.size(); ++i) {
    x.push_back(std::floor(3.0 * draws.next()));
    y.push_back(x.back() + (draws.next() - 0.5) * std::sqrt(12.0 * 2.0 / 3.0));
  }
  const auto index = GivenData(y, unit, {0.9999, 1}).first_order(x);
  ASSERT_TRUE(index);
  EXPECT_LT(index->low, 0.5);
  EXPECT_GT(index->high, 0.5);
  EXPECT_LT(index->high - index->low, 0.1);
}

TEST(GivenData, PairsNoTrialsOfTheSameDraw) {
  // Five trials a draw that share their noise: without regard to units x would seem to explain it.
  Simulation drawn;
  Simulation swept;
  for (std::uint64_t repeat = 0; repeat < 200; ++repeat) {
    Draws draws(repeat);
    std::vector<double> x, level, y;
    std::vector<std::uint64_t> unit;
    for (std::uint64_t draw = 0; draw < 200; ++draw) {
      const double u = draws.next();
      const double noise = draws.next();
      for (int cell = 0; cell < 5; ++cell) {
        x.push_back(u);
        level.push_back(cell);
        y.push_back(noise);
        unit.push_back(draw);
      }
    }
    const GivenData given(y, unit, {0.95, repeat});
    drawn.add(*given.first_order(x), 0.0);
    swept.add(*given.first_order(level), 0.0);
  }
  EXPECT_NEAR(drawn.mean(), 0.0, 4.0 * drawn.standard_error_of_mean());
  EXPECT_GE(drawn.coverage(), least_coverage(200));
  EXPECT_NEAR(swept.mean(), 0.0, 1e-12);  // each level has the same draws
}

TEST(GivenData, FindsTheShareOfASweepOverSharedDraws) {
  Draws draws(6);
  std::vector<double> level, y;
  std::vector<std::uint64_t> unit;
  for (std::uint64_t draw = 0; draw < 500; ++draw) {
    const double noise = std::sqrt(12.0) * (draws.next() - 0.5);
    for (int cell = 0; cell < 3; ++cell) {
      level.push_back(cell);
      y.push_back(std::sqrt(1.5) * cell + noise);  // the levels' variance is 1 as well
      unit.push_back(draw);
    }
  }
  const auto index = GivenData(y, unit, {0.9999, 1}).first_order(level);
  ASSERT_TRUE(index);
  EXPECT_LT(index->low, 0.5);
  EXPECT_GT(index->high, 0.5);
  EXPECT_LT(index->high - index->low, 0.15);
}

TEST(GivenData, DoesNotDependOnTheOrderOfTheTrialsOrAnIncreasingTransformOfX) {
  const Sample sample = sample_of(cliffs(), 500, 1);
  const auto before = GivenData(sample.y, sample.unit, {}).first_order(sample.x[0]);
  Sample reversed = sample;
  std::reverse(reversed.y.begin(), reversed.y.end());
  std::reverse(reversed.unit.begin(), reversed.unit.end());
  std::reverse(reversed.x[0].begin(), reversed.x[0].end());
  for (double& x : reversed.x[0]) x = std::exp(10.0 * x);
  const auto after = GivenData(reversed.y, reversed.unit, {}).first_order(reversed.x[0]);
  EXPECT_NEAR(before->estimate, after->estimate, 1e-12);
  EXPECT_NEAR(before->high, after->high, 1e-12);
}

TEST(GivenData, TheSameSeedGivesTheSameIntervalAndAnotherAnother) {
  const Sample sample = sample_of(cliffs(), 500, 1);
  const auto one = GivenData(sample.y, sample.unit, {0.95, 1}).first_order(sample.x[0]);
  EXPECT_EQ(one, GivenData(sample.y, sample.unit, {0.95, 1}).first_order(sample.x[0]));
  EXPECT_NE(one, GivenData(sample.y, sample.unit, {0.95, 2}).first_order(sample.x[0]));
}

TEST(GivenData, SaysNothingOfFewTrialsOrAConstant) {
  const Sample sample = sample_of(cliffs(), least_sensitivity_sample, 1);
  EXPECT_TRUE(GivenData(sample.y, sample.unit, {}).first_order(sample.x[0]));
  const std::size_t fewer = least_sensitivity_sample - 1;
  const GivenData few(std::span(sample.y).first(fewer), std::span(sample.unit).first(fewer), {});
  EXPECT_FALSE(few.first_order(std::span(sample.x[0]).first(fewer)));
  const GivenData constant(std::vector<double>(sample.y.size(), 0.1), sample.unit, {});
  EXPECT_FALSE(constant.first_order(sample.x[0]));
  EXPECT_FALSE(GivenData({}, {}, {}).first_order({}));
}

TEST(GivenData, RefusesColumnsOfDifferentLengths) {
  const std::vector<double> y(100);
  const std::vector<std::uint64_t> unit(99);
  EXPECT_THROW(GivenData(y, unit, {}), std::invalid_argument);
  EXPECT_THROW((void)GivenData(y, std::vector<std::uint64_t>(100), {}).first_order(std::vector<double>(99)),
               std::invalid_argument);
}

TEST(FactorialIndex, IsTheShareBetweenLevels) {
  // Two factors, three by two: y = 10 a + b.
  const std::vector<double> a{0, 0, 1, 1, 2, 2};
  const std::vector<double> b{0, 1, 0, 1, 0, 1};
  const std::vector<double> y{0, 1, 10, 11, 20, 21};
  const double all = 200.0 / 3.0 + 0.25;
  EXPECT_NEAR(factorial_index(a, y)->estimate, 200.0 / 3.0 / all, 1e-15);
  EXPECT_NEAR(factorial_index(b, y)->estimate, 0.25 / all, 1e-15);
  EXPECT_EQ(factorial_index(b, y)->low, factorial_index(b, y)->estimate);
  EXPECT_EQ(factorial_index(b, y)->high, factorial_index(b, y)->estimate);
  EXPECT_FALSE(factorial_index(a, std::vector<double>(6, 0.1)));
}

}  // namespace
}  // namespace steerstat
