#include "statistics/subset_levels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace steerstat {
namespace {

constexpr double failure = std::numeric_limits<double>::infinity();

TEST(SubsetLevels, BeginWithPlainDrawsAndGoOnFromTheWorstTenth) {
  SubsetLevels levels(20, 3);
  ASSERT_EQ(levels.due().size(), 20U);
  for (const auto& parent : levels.due()) EXPECT_FALSE(parent);
  std::vector<double> performances;
  for (int i = 0; i < 20; ++i) performances.push_back(i);
  levels.take(performances);
  ASSERT_EQ(levels.levels().size(), 1U);
  EXPECT_EQ(levels.levels()[0].threshold, 17.5);  // between the second and the third worst
  EXPECT_EQ(levels.levels()[0].probability, 0.1);
  ASSERT_EQ(levels.due().size(), 2U);
  EXPECT_EQ(levels.due()[0], 19U);
  EXPECT_EQ(levels.due()[1], 18U);
}

TEST(SubsetLevels, RefuseCandidatesBelowTheThresholdAndTakeThoseAtIt) {
  SubsetLevels levels(20, 3);
  std::vector<double> performances;
  for (int i = 0; i < 20; ++i) performances.push_back(i);
  levels.take(performances);
  levels.take(std::vector<double>{17.5, std::nextafter(17.5, 0.0)});
  EXPECT_EQ(levels.due()[0], 20U);
  EXPECT_EQ(levels.due()[1], 18U);
  EXPECT_EQ(levels.level_of(19), 0U);
  EXPECT_EQ(levels.level_of(20), 1U);
  EXPECT_EQ(levels.level_of(37), 1U);
  EXPECT_EQ(levels.level_of(38), 2U);
}

TEST(SubsetLevels, EndWhereATenthOfTheStatesFails) {
  std::vector<double> performances(20, 1.0);
  performances[3] = performances[7] = failure;
  SubsetLevels levels(20, 5);
  levels.take(performances);
  EXPECT_EQ(levels.end(), SubsetEnd::failure);
  EXPECT_TRUE(levels.due().empty());
  EXPECT_FALSE(levels.levels()[0].threshold);
  EXPECT_EQ(levels.levels()[0].probability, 0.1);
  EXPECT_EQ(levels.nominal().successes, 2U);

  performances[7] = 2.0;  // one less
  SubsetLevels more(20, 5);
  more.take(performances);
  EXPECT_FALSE(more.ended());
}

TEST(SubsetLevels, EndWhereTheThresholdRisesNoMore) {
  SubsetLevels levels(20, 9);
  levels.take(std::vector<double>(20, 1.0));
  while (!levels.ended()) levels.take(std::vector<double>(levels.due().size(), 1.0));
  EXPECT_EQ(levels.end(), SubsetEnd::stagnation);
  const SubsetEstimate found = subset_estimate(levels, 0.95);
  EXPECT_FALSE(found.trusted);
  EXPECT_EQ(found.estimate, 0.0);
  EXPECT_EQ(found.low, 0.0);
  EXPECT_NEAR(found.high, 1.0 - std::pow(0.025, 1.0 / 20.0), 1e-12);
}

TEST(SubsetLevels, EndWithTheLastLevelAllowed) {
  SubsetLevels levels(20, 1);
  std::vector<double> performances(20, 1.0);
  performances[0] = failure;
  levels.take(performances);
  EXPECT_EQ(levels.end(), SubsetEnd::levels);
  EXPECT_EQ(levels.levels()[0].probability, 0.05);
  EXPECT_FALSE(subset_estimate(levels, 0.95).trusted);
}

TEST(SubsetLevels, AreNotTrustedWhereTheirChainsStandStill) {
  for (const bool moves : {false, true}) {
    SubsetLevels levels(20, 5);
    std::vector<double> performances;
    for (int i = 0; i < 20; ++i) performances.push_back(i);
    levels.take(performances);
    // Of 18 candidates none is accepted, or two, one more than a tenth.
    for (int step = 0; step < 9; ++step) levels.take(std::vector<double>(2, moves && step == 0 ? 20.0 : 0.0));
    ASSERT_EQ(levels.levels().size(), 2U);
    EXPECT_EQ(levels.levels()[1].acceptance, moves ? 2.0 / 18.0 : 0.0);
    while (!levels.ended()) levels.take(std::vector<double>(levels.due().size(), failure));
    EXPECT_EQ(levels.end(), SubsetEnd::failure);
    const std::string reason = subset_estimate(levels, 0.95).reason;
    EXPECT_EQ(reason.find("hardly move") == std::string::npos, moves) << reason;
  }
}

TEST(SubsetLevels, RefuseWhatMakesNoChains) {
  EXPECT_THROW(SubsetLevels(25, 3), std::invalid_argument);
  EXPECT_THROW(SubsetLevels(0, 3), std::invalid_argument);
  EXPECT_THROW(SubsetLevels(20, 0), std::invalid_argument);
  SubsetLevels levels(20, 3);
  EXPECT_THROW(levels.take(std::vector<double>(19, 1.0)), std::invalid_argument);
  EXPECT_THROW(subset_estimate(levels, 0.95), std::invalid_argument);
}

// The linear limit state: the sum of standard normals over sqrt(dimensions) exceeds beta, with probability Phi(-beta)
// in any dimension.
struct Repeats {
  double mean{0.0};  // of the estimates, over the truth
  double spread{0.0};
  double predicted{0.0};  // mean coefficient of variation
  int covered{0};
};

Repeats repeat(double beta, std::size_t dimensions, std::uint64_t states, int repeats) {
  const double truth = 0.5 * std::erfc(beta / std::sqrt(2.0));
  std::mt19937_64 engine(17);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  Repeats result;
  double squares = 0.0;
  for (int i = 0; i < repeats; ++i) {
    SubsetLevels levels(states, 12);
    std::vector<std::vector<double>> points;
    std::vector<double> performances;
    while (!levels.ended()) {
      performances.clear();
      for (const auto& parent : levels.due()) {
        std::vector<double> point(dimensions);
        double sum = 0.0;
        for (std::size_t k = 0; k < dimensions; ++k) {
          point[k] = normal(engine);
          if (parent) {
            const double from = points[*parent][k];
            const double to = from + 2.0 * uniform(engine) - 1.0;
            point[k] = uniform(engine) < std::exp(0.5 * (from * from - to * to)) ? to : from;
          }
          sum += point[k];
        }
        points.push_back(std::move(point));
        const double z = sum / std::sqrt(static_cast<double>(dimensions));
        performances.push_back(z > beta ? failure : z);
      }
      levels.take(performances);
    }
    const SubsetEstimate found = subset_estimate(levels, 0.95);
    EXPECT_TRUE(found.trusted) << found.reason;
    const double ratio = found.estimate / truth;
    result.mean += ratio / repeats;
    squares += ratio * ratio / repeats;
    result.predicted += found.variation / repeats;
    result.covered += found.low <= truth && truth <= found.high ? 1 : 0;
  }
  result.spread = std::sqrt(squares - result.mean * result.mean);
  return result;
}

class SubsetLimitState : public ::testing::TestWithParam<double> {};

TEST_P(SubsetLimitState, IsEstimatedAndCovered) {
  constexpr int repeats = 80;
  const Repeats found = repeat(GetParam(), 4, 1000, repeats);  // 3.719 and 4.753: 1e-4 and 1e-6
  // The estimate has a bias of the order of its squared variation [Au and Beck 2001].
  EXPECT_NEAR(found.mean, 1.0, 4.0 * found.spread / std::sqrt(repeats) + found.spread * found.spread);
  // The sum of the levels' variations is an upper one.
  EXPECT_GT(found.predicted, found.spread);
  EXPECT_GE(found.covered, 0.95 * repeats - 3.0 * std::sqrt(0.95 * 0.05 * repeats));
}

INSTANTIATE_TEST_SUITE_P(Beta, SubsetLimitState, ::testing::Values(3.719016485455709, 4.753424308822899));

}  // namespace
}  // namespace steerstat
