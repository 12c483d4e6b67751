#include "sampling/distribution.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "sampling/normal_probability.hpp"
#include "sampling/stream.hpp"

namespace steerstat {
namespace {

constexpr double first_u = 0x1p-53;
constexpr double last_u = 1.0 - 0x1p-53;

double phi(double z) {
  return std::exp(-0.5 * z * z) / std::sqrt(2.0 * M_PI);
}

// A distribution with what theory says of it.
struct Theory {
  std::string name;
  Distribution::Shape shape;
  double mean;
  double variance;
  std::function<double(double)> probability;  // distribution function, of continuous ones

  friend std::ostream& operator<<(std::ostream& stream, const Theory& theory) { return stream << theory.name; }
};

Theory uniform() {
  return {"uniform", Uniform{0.8, 1.2}, 1.0, 0.16 / 12.0, [](double x) { return (x - 0.8) / 0.4; }};
}

Theory normal() {
  return {"normal", Normal{-2.0, 3.0}, -2.0, 9.0, [](double x) { return normal_probability((x + 2.0) / 3.0); }};
}

Theory truncated_normal(const std::string& name, double mean, double std, double low, double high) {
  const double a = (low - mean) / std;
  const double b = (high - mean) / std;
  // Of the tail that holds the bounds, so that the difference keeps its digits.
  const double z =
      a > 0.0 ? normal_probability(-a) - normal_probability(-b) : normal_probability(b) - normal_probability(a);
  const double shift = (phi(a) - phi(b)) / z;
  const double variance = std * std * (1.0 + (a * phi(a) - b * phi(b)) / z - shift * shift);
  return {name, TruncatedNormal(mean, std, low, high), mean + std * shift, variance, [=](double x) {
            const double c = (x - mean) / std;
            return a > 0.0 ? (normal_probability(-a) - normal_probability(-c)) / z
                           : (normal_probability(c) - normal_probability(a)) / z;
          }};
}

Theory lognormal() {
  const double sigma = 0.25;
  return {"lognormal", Lognormal{2.0, sigma}, 2.0 * std::exp(0.5 * sigma * sigma),
          4.0 * std::exp(sigma * sigma) * (std::exp(sigma * sigma) - 1.0),
          [=](double x) { return normal_probability(std::log(x / 2.0) / sigma); }};
}

Theory triangular(const std::string& name, double low, double mode, double high) {
  const double variance = (low * low + mode * mode + high * high - low * mode - low * high - mode * high) / 18.0;
  return {name, Triangular{low, mode, high}, (low + mode + high) / 3.0, variance, [=](double x) {
            return x < mode ? (x - low) * (x - low) / ((high - low) * (mode - low))
                            : 1.0 - (high - x) * (high - x) / ((high - low) * (high - mode));
          }};
}

Theory discrete() {
  // Probabilities 0.2, 0, 0.5, 0.3.
  return {"discrete", Discrete({1.0, 100.0, -1.0, 4.0}, {2.0, 0.0, 5.0, 3.0}), 0.9, 0.2 + 0.5 + 4.8 - 0.81, {}};
}

class OfAnyDistribution : public ::testing::TestWithParam<Theory> {
 protected:
  [[nodiscard]] static double quantile(double u) { return Distribution{GetParam().shape}.quantile(u); }

  [[nodiscard]] static std::vector<double> draws(std::size_t n) {
    const UniformStream stream(11, GetParam().name);
    std::vector<double> values(n);
    for (std::size_t i = 0; i < n; ++i) values[i] = quantile(stream.at(i));
    return values;
  }
};

class OfContinuousDistribution : public OfAnyDistribution {};

TEST_P(OfAnyDistribution, MeanAndVarianceAreWithinTheirStandardErrors) {
  const auto x = draws(200'000);
  const auto n = static_cast<double>(x.size());
  double sum = 0.0;
  for (const double value : x) sum += value - GetParam().mean;
  EXPECT_LT(std::abs(sum / n), 4.5 * std::sqrt(GetParam().variance / n));
  double second = 0.0;
  double fourth = 0.0;
  for (const double value : x) {
    const double square = std::pow(value - GetParam().mean, 2);
    second += square / n;
    fourth += square * square / n;
  }
  EXPECT_LT(std::abs(second - GetParam().variance), 4.5 * std::sqrt((fourth - second * second) / n));
}

TEST_P(OfContinuousDistribution, EmpiricalDistributionIsWithinKolmogorovsBound) {
  auto x = draws(100'000);
  std::sort(x.begin(), x.end());
  const auto n = static_cast<double>(x.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double p = GetParam().probability(x[i]);
    const auto rank = static_cast<double>(i);
    distance = std::max({distance, std::abs(p - rank / n), std::abs((rank + 1.0) / n - p)});
  }
  EXPECT_LT(distance, 1.95 / std::sqrt(n));  // exceeded once in a thousand samples
}

TEST_P(OfContinuousDistribution, QuantileInvertsTheDistributionFunction) {
  for (double u = 1e-6; u < 1.0; u += 0.00731) EXPECT_NEAR(GetParam().probability(quantile(u)), u, 2e-14);
}

TEST_P(OfContinuousDistribution, QuantileNeverDecreasesAndStaysInTheSupport) {
  const Support support = Distribution{GetParam().shape}.support();
  double last = quantile(first_u);
  EXPECT_GE(last, support.low);
  for (double u = 1e-9; u < 1.0; u += 0.0003) {
    const double x = quantile(u);
    EXPECT_GE(x, last) << u;
    last = x;
  }
  EXPECT_LE(quantile(last_u), support.high);
  EXPECT_TRUE(std::isfinite(quantile(first_u)) && std::isfinite(quantile(last_u)));
}

const auto continuous =
    ::testing::Values(uniform(), normal(), truncated_normal("truncated_around_the_mean", 1.0, 0.1, 0.8, 1.3),
                      truncated_normal("truncated_above_the_mean", 0.0, 1.0, 5.0, 7.0),
                      truncated_normal("truncated_below_the_mean", 0.0, 1.0, -7.0, -5.0), lognormal(),
                      triangular("triangular", 0.0, 1.0, 4.0), triangular("triangular_with_mode_at_low", 1.0, 1.0, 3.0),
                      triangular("triangular_with_mode_at_high", 1.0, 3.0, 3.0));
const auto name_of_theory = [](const auto& instance) { return instance.param.name; };

INSTANTIATE_TEST_SUITE_P(Continuous, OfAnyDistribution, continuous, name_of_theory);
INSTANTIATE_TEST_SUITE_P(Discrete, OfAnyDistribution, ::testing::Values(discrete()), name_of_theory);
INSTANTIATE_TEST_SUITE_P(Shapes, OfContinuousDistribution, continuous, name_of_theory);

TEST(Uniform, QuantilesAreKnown) {
  EXPECT_EQ((Uniform{2.0, 6.0}.quantile(0.25)), 3.0);
  EXPECT_EQ((Uniform{-1.0, 1.0}.quantile(0.5)), 0.0);
}

TEST(Uniform, RoundingNeverStepsOverTheUpperBound) {
  for (double low = -3.1; low < 3.0; low += 0.0137) {
    for (const double high : {low + 1e-15, low + 0.1, low + 7.7}) {
      if (!(low < high)) continue;
      EXPECT_LE((Uniform{low, high}.quantile(last_u)), high);
      EXPECT_GE((Uniform{low, high}.quantile(first_u)), low);
    }
  }
}

TEST(Normal, QuantilesAreKnown) {
  EXPECT_NEAR((Normal{10.0, 2.0}.quantile(0.975)), 10.0 + 2.0 * 1.959963984540054, 1e-13);
  EXPECT_EQ((Normal{10.0, 2.0}.quantile(0.5)), 10.0);
}

TEST(Lognormal, MedianIsTheMiddleQuantile) {
  EXPECT_EQ((Lognormal{3.0, 0.7}.quantile(0.5)), 3.0);
  EXPECT_NEAR((Lognormal{1.0, 0.5}.quantile(0.8413447460685429)), std::exp(0.5), 1e-14);
}

TEST(Triangular, QuantilesAreKnownOnBothSidesOfTheMode) {
  const Triangular shape{0.0, 1.0, 4.0};
  EXPECT_EQ(shape.quantile(0.25), 1.0);                            // F(mode) = 1/4
  EXPECT_EQ(shape.quantile(0.0625), 0.5);                          // below: F = x^2 / 4
  EXPECT_NEAR(shape.quantile(0.75), 4.0 - std::sqrt(3.0), 1e-15);  // above: 1 - F = (4 - x)^2 / 12
}

TEST(TruncatedNormal, BoundsAreWithinEightStandardDeviationsOfTheMean) {
  EXPECT_TRUE(TruncatedNormal::bounds_hold_probability(0.0, 1.0, 8.0, 9.0));
  EXPECT_FALSE(TruncatedNormal::bounds_hold_probability(0.0, 1.0, std::nextafter(8.0, 9.0), 9.0));
  EXPECT_TRUE(TruncatedNormal::bounds_hold_probability(0.0, 1.0, -9.0, -8.0));
  EXPECT_FALSE(TruncatedNormal::bounds_hold_probability(0.0, 1.0, -9.0, std::nextafter(-8.0, -9.0)));
}

TEST(TruncatedNormal, TailsAboveAndBelowTheMeanMirrorEachOther) {
  const TruncatedNormal above(0.0, 1.0, 7.5, 9.0);
  const TruncatedNormal below(0.0, 1.0, -9.0, -7.5);
  for (double u = 0.05; u < 1.0; u += 0.05) EXPECT_NEAR(above.quantile(u), -below.quantile(1.0 - u), 1e-13) << u;
  // Nearly exponential with rate 7.5 + 1 / 7.5 there.
  EXPECT_NEAR(above.quantile(0.5), 7.5 + std::log(2.0) / 7.633, 0.005);
}

TEST(TruncatedNormal, WideBoundsLeaveTheNormalAsItIs) {
  const TruncatedNormal truncated(2.0, 0.5, -1e6, 1e6);
  const Normal whole{2.0, 0.5};
  for (double u = 0.01; u < 1.0; u += 0.01) EXPECT_NEAR(truncated.quantile(u), whole.quantile(u), 1e-14);
}

TEST(Discrete, WeightsBoundTheValuesOnBothSides) {
  const Discrete shape({10.0, 20.0, 30.0}, {1.0, 1.0, 2.0});
  EXPECT_EQ(shape.quantile(first_u), 10.0);
  EXPECT_EQ(shape.quantile(std::nextafter(0.25, 0.0)), 10.0);
  EXPECT_EQ(shape.quantile(0.25), 20.0);
  EXPECT_EQ(shape.quantile(std::nextafter(0.5, 0.0)), 20.0);
  EXPECT_EQ(shape.quantile(0.5), 30.0);
  EXPECT_EQ(shape.quantile(last_u), 30.0);
}

TEST(Discrete, ValuesWithoutWeightAreNeverDrawn) {
  const Discrete shape({1.0, 2.0, 3.0, 4.0, 5.0}, {0.0, 1.0, 0.0, 1.0, 0.0});
  for (const double u : {first_u, 0.25, std::nextafter(0.5, 0.0)}) EXPECT_EQ(shape.quantile(u), 2.0) << u;
  for (const double u : {0.5, 0.75, last_u}) EXPECT_EQ(shape.quantile(u), 4.0) << u;
  EXPECT_EQ(shape.support().low, 2.0);
  EXPECT_EQ(shape.support().high, 4.0);
}

TEST(Discrete, TheSmallestWeightStillGivesAValue) {
  EXPECT_EQ(Discrete({7.0, 8.0}, {5e-324, 0.0}).quantile(last_u), 7.0);
}

TEST(Discrete, DrawsComeInProportionToTheirWeights) {
  const Discrete shape({1.0, 2.0, 3.0}, {0.5, 0.2, 0.3});
  const UniformStream stream(3, "weights");
  constexpr int n = 100'000;
  std::array<int, 3> counts{};
  for (int i = 0; i < n; ++i) {
    ++counts[static_cast<std::size_t>(shape.quantile(stream.at(static_cast<std::uint64_t>(i)))) - 1];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const double p = shape.weights()[k];
    EXPECT_NEAR(counts[k], n * p, 4.5 * std::sqrt(n * p * (1.0 - p))) << k;
  }
}

TEST(Distribution, EqualityComparesShapeNumbersAndRelative) {
  const Distribution a{Uniform{0.0, 1.0}, false};
  EXPECT_EQ(a, (Distribution{Uniform{0.0, 1.0}, false}));
  EXPECT_NE(a, (Distribution{Uniform{0.0, 1.0}, true}));
  EXPECT_NE(a, (Distribution{Uniform{0.0, 1.5}, false}));
  EXPECT_NE(a, (Distribution{Normal{0.0, 1.0}, false}));
}

TEST(Distribution, SupportsSayWhichBoundsAreNeverDrawn) {
  EXPECT_FALSE((Distribution{Lognormal{1.0, 1.0}}.support().includes_low));
  EXPECT_EQ((Distribution{Lognormal{1.0, 1.0}}.support().low), 0.0);
  EXPECT_TRUE((Distribution{Uniform{0.0, 1.0}}.support().includes_low));
  EXPECT_EQ((Distribution{Normal{0.0, 1.0}}.support().low), -INFINITY);
}

}  // namespace
}  // namespace steerstat
