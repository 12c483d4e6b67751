#include "statistics/weighted_failures.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

namespace steerstat {
namespace {

std::vector<WeightedDraw> plain(std::size_t draws, std::size_t failures) {
  std::vector<WeightedDraw> sample(draws, {1.0, true, false});
  for (std::size_t i = 0; i < failures; ++i) sample[i].failed = true;
  return sample;
}

TEST(WeightedSumInterval, IsTheExactPoissonIntervalWhereWeightsAreEqual) {
  const double weight = 0.3;
  const double count = 12.0;
  const auto interval = weighted_sum_interval(count * weight, count * weight * weight, weight, 0.95);
  const auto chi = [](double degrees, double p) {
    return boost::math::quantile(boost::math::chi_squared(degrees), p) / 2.0;
  };
  EXPECT_NEAR(interval.low, weight * chi(2.0 * count, 0.025), 1e-12);  // [Garwood 1936]
  EXPECT_NEAR(interval.high, weight * chi(2.0 * count + 2.0, 0.975), 1e-12);
}

TEST(WeightedSumInterval, RefusesWhatIsNoSumOfWeights) {
  EXPECT_THROW(weighted_sum_interval(0.0, 0.0, 0.0, 0.95), std::invalid_argument);
  EXPECT_THROW(weighted_sum_interval(1.0, 1.0, 1.0, 1.0), std::invalid_argument);
}

TEST(WeightedFailures, OfPlainDrawsIsTheirShare) {
  const WeightedFailures found = weighted_failures(plain(1000, 30), 0.95);
  EXPECT_EQ(found.estimate, 0.03);
  EXPECT_NEAR(found.standard_error, std::sqrt(0.03 * 0.97 / 1000.0), 1e-15);
  EXPECT_EQ(found.effective_failures, 30.0);
  EXPECT_EQ(found.effective_draws, 1000.0);
  EXPECT_EQ(found.mean_weight, 1.0);
  EXPECT_TRUE(found.trusted) << found.reason;
  EXPECT_LT(found.low, 0.03);
  EXPECT_GT(found.high, 0.03);
}

TEST(WeightedFailures, AreTrustedFromTwentyEffectiveFailuresOn) {
  EXPECT_TRUE(weighted_failures(plain(1000, 20), 0.95).trusted);
  EXPECT_FALSE(weighted_failures(plain(1000, 19), 0.95).trusted);
}

TEST(WeightedFailures, AreNotTrustedWhereOneWeighsMoreThanATenth) {
  auto sample = plain(100'000, 90);
  sample[0].weight = 9.8;  // 9.8 of 98.8
  EXPECT_TRUE(weighted_failures(sample, 0.95).trusted);
  sample[0].weight = 10.0;  // 10 of 99
  const WeightedFailures found = weighted_failures(sample, 0.95);
  EXPECT_FALSE(found.trusted);
  EXPECT_NEAR(found.largest_share, 10.0 / 99.0, 1e-15);
}

TEST(WeightedFailures, AreNotTrustedWhereWeightsDoNotAverageToOne) {
  auto sample = plain(1000, 100);
  for (std::size_t i = 0; i < sample.size(); ++i) sample[i].weight = i % 2 == 0 ? 0.5 : 1.0;
  const WeightedFailures found = weighted_failures(sample, 0.95);
  EXPECT_FALSE(found.trusted);
  EXPECT_NE(found.reason.find("average"), std::string::npos);
}

TEST(WeightedFailures, FallBackOnTheNominalDrawsWhereTheyAreNotTrusted) {
  auto sample = plain(1000, 0);
  for (std::size_t i = 0; i < 400; ++i) sample[i].nominal = false;
  const WeightedFailures found = weighted_failures(sample, 0.95);
  EXPECT_FALSE(found.trusted);
  EXPECT_EQ(found.estimate, 0.0);
  EXPECT_EQ(found.nominal.trials, 600U);
  EXPECT_EQ(found.low, 0.0);
  EXPECT_NEAR(found.high, 1.0 - std::pow(0.025, 1.0 / 600.0), 1e-12);
}

TEST(WeightedFailures, WithoutNominalDrawsOrTrustAreAnywhere) {
  const std::vector<WeightedDraw> sample(5, {1.0, false, false});
  const WeightedFailures found = weighted_failures(sample, 0.95);
  EXPECT_EQ(found.low, 0.0);
  EXPECT_EQ(found.high, 1.0);
  EXPECT_FALSE(found.nominal_interval);
}

TEST(WeightedFailures, RefuseNoDraws) {
  EXPECT_THROW(weighted_failures({}, 0.95), std::invalid_argument);
}

// The linear limit state in standard normals: failure is z > beta, with probability Phi(-beta) whatever the dimension,
// as the proposal moves the one direction that counts.
struct WeightedRepeats {
  double mean{0.0};       // of the estimates, over the truth
  double spread{0.0};     // their standard deviation, over the truth
  double predicted{0.0};  // the mean of their standard errors, over the truth
  int covered{0};
  int trusted{0};
};

WeightedRepeats repeat(double beta, double shift, double nominal, int repeats, int draws) {
  const double truth = 0.5 * std::erfc(beta / std::sqrt(2.0));
  WeightedRepeats result;
  double squares = 0.0;
  std::mt19937_64 engine(71);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  std::vector<WeightedDraw> sample(static_cast<std::size_t>(draws));
  for (int i = 0; i < repeats; ++i) {
    for (WeightedDraw& draw : sample) {
      draw.nominal = uniform(engine) < nominal;
      const double z = normal(engine) + (draw.nominal ? 0.0 : shift);
      draw.weight = 1.0 / (nominal + (1.0 - nominal) * std::exp(shift * z - 0.5 * shift * shift));
      draw.failed = z > beta;
    }
    const WeightedFailures found = weighted_failures(sample, 0.95);
    const double ratio = found.estimate / truth;
    result.mean += ratio / repeats;
    squares += ratio * ratio / repeats;
    result.predicted += found.standard_error / truth / repeats;
    result.covered += found.low <= truth && truth <= found.high ? 1 : 0;
    result.trusted += found.trusted ? 1 : 0;
  }
  result.spread = std::sqrt(squares - result.mean * result.mean);
  return result;
}

class WeightedLimitState : public ::testing::TestWithParam<double> {};

TEST_P(WeightedLimitState, IsEstimatedWithoutBiasWithTheErrorItTellsAndCoveredByItsInterval) {
  const double beta = GetParam();  // 3.719 and 4.753: 1e-4 and 1e-6
  constexpr int repeats = 600;
  const WeightedRepeats found = repeat(beta, beta, 0.2, repeats, 1000);
  EXPECT_NEAR(found.mean, 1.0, 4.0 * found.spread / std::sqrt(repeats));
  // A standard deviation is known to one in sqrt(2 n); the estimates are nearly normal.
  EXPECT_NEAR(found.predicted / found.spread, 1.0, 4.0 / std::sqrt(2.0 * repeats));
  EXPECT_EQ(found.trusted, repeats);
  EXPECT_GE(found.covered, 0.95 * repeats - 3.0 * std::sqrt(0.95 * 0.05 * repeats));
}

INSTANTIATE_TEST_SUITE_P(Beta, WeightedLimitState, ::testing::Values(3.719016485455709, 4.753424308822899));

TEST(WeightedFailures, CoverAtSmallSamplesToo) {
  constexpr int repeats = 600;
  for (const int draws : {60, 200}) {
    const WeightedRepeats found = repeat(3.0, 2.5, 0.3, repeats, draws);
    EXPECT_GE(found.covered, 0.95 * repeats - 3.0 * std::sqrt(0.95 * 0.05 * repeats)) << draws;
  }
}

// What the flag is for: a proposal that looks the other way. The estimate would be far off, and the interval is not.
TEST(WeightedFailures, AreNeitherTrustedNorWrongWhereTheProposalLooksElsewhere) {
  constexpr int repeats = 200;
  const WeightedRepeats found = repeat(2.5, -2.5, 0.5, repeats, 2000);
  EXPECT_LT(found.trusted, repeats / 20);
  EXPECT_GE(found.covered, 0.95 * repeats - 3.0 * std::sqrt(0.95 * 0.05 * repeats));
}

}  // namespace
}  // namespace steerstat
