#include "statistics/proportion_drop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "statistics/proportion.hpp"

namespace steerstat {
namespace {

/// (n + 1) probabilities of 0, 1, ... n successes.
std::vector<double> binomial_probabilities(std::uint64_t n, double p) {
  std::vector<double> probabilities;
  const auto trials = static_cast<double>(n);
  for (std::uint64_t i = 0; i <= n; ++i) {
    const auto x = static_cast<double>(i);
    const double ways = std::lgamma(trials + 1.0) - std::lgamma(x + 1.0) - std::lgamma(trials - x + 1.0);
    const double certain = (p <= 0.0 && i == 0) || (p >= 1.0 && i == n) ? 1.0 : 0.0;
    probabilities.push_back(p > 0.0 && p < 1.0 ? std::exp(ways + x * std::log(p) + (trials - x) * std::log1p(-p))
                                               : certain);
  }
  return probabilities;
}

/// P(event(x before, x after)) over both samples, by enumeration.
template <class Event>
double probability_of(const Event& event, std::uint64_t n_before, double p_before, std::uint64_t n_after,
                      double p_after) {
  const std::vector<double> before = binomial_probabilities(n_before, p_before);
  const std::vector<double> after = binomial_probabilities(n_after, p_after);
  double sum = 0.0;
  for (std::uint64_t i = 0; i <= n_before; ++i) {
    for (std::uint64_t j = 0; j <= n_after; ++j) {
      if (event(i, j)) sum += before[i] * after[j];
    }
  }
  return sum;
}

/// A table of an event for every outcome: the enumeration asks for each many times.
template <class Event>
auto tabulated(const Event& event, std::uint64_t n_before, std::uint64_t n_after) {
  std::vector<char> table;
  for (std::uint64_t i = 0; i <= n_before; ++i) {
    for (std::uint64_t j = 0; j <= n_after; ++j) table.push_back(event(i, j) ? 1 : 0);
  }
  return [table, n_after](std::uint64_t i, std::uint64_t j) { return table[i * (n_after + 1) + j] != 0; };
}

const std::vector<double> rates{0.002, 0.01, 0.03, 0.1, 0.3, 0.5, 0.7, 0.9, 0.97, 0.99, 0.998};
const std::vector<std::pair<std::uint64_t, std::uint64_t>> sizes{{5, 5}, {20, 20}, {60, 60}, {300, 20}, {20, 300}};
constexpr double drop_level = 0.05;

TEST(ProportionDrop, FindsADropOfNothingSignificantNoMoreOftenThanTheLevelSays) {
  for (const auto& [before, after] : sizes) {
    const std::uint64_t n0 = before;
    const std::uint64_t n1 = after;
    const auto significant = tabulated(
        [&](std::uint64_t i, std::uint64_t j) {
          return proportion_drop({i, n0}, {j, n1}, drop_level).low > 0.0;
        },
        n0, n1);
    for (const double p : rates) {
      EXPECT_LE(probability_of(significant, n0, p, n1, p), drop_level) << n0 << ", " << n1 << " trials at " << p;
    }
  }
}

TEST(ProportionDrop, RulesOutADropOfTheMarginNoMoreOftenThanTheLevelSaysAndATwentiethOfIt) {
  for (const double margin : {0.02, 0.1}) {
    for (const auto& [before, after] : sizes) {
      const std::uint64_t n0 = before;
      const std::uint64_t n1 = after;
      const auto ruled_out = tabulated(
          [&](std::uint64_t i, std::uint64_t j) {
            return proportion_drop({i, n0}, {j, n1}, drop_level).high < margin;
          },
          n0, n1);
      for (const double p : rates) {
        if (p + margin > 1.0) continue;
        EXPECT_LE(probability_of(ruled_out, n0, p + margin, n1, p), 1.05 * drop_level)
            << n0 << ", " << n1 << " trials from " << p + margin << " to " << p;
      }
    }
  }
}

TEST(ProportionDrop, KeepsTheLevelWhereWilsonsLimitsDoNot) {
  // Newcombe's own choice of limits, at a success rate of 0.99: the reason for this one's.
  const auto significant_by_wilson = [](std::uint64_t i, std::uint64_t j) {
    const ProportionInterval before = wilson_interval(i, 300, 1.0 - 2.0 * drop_level);
    const ProportionInterval after = wilson_interval(j, 20, 1.0 - 2.0 * drop_level);
    return before.estimate - after.estimate > std::hypot(before.estimate - before.low, after.high - after.estimate);
  };
  EXPECT_GT(probability_of(significant_by_wilson, 300, 0.99, 20, 0.99), 1.5 * drop_level);
}

TEST(ProportionDrop, IsDefinedAtNoAndAtAllSuccesses) {
  const ProportionDrop none = proportion_drop({0, 100}, {0, 100}, drop_level);
  EXPECT_EQ(none.estimate, 0.0);
  EXPECT_LT(none.low, 0.0);
  EXPECT_GT(none.high, 0.0);
  const ProportionDrop all = proportion_drop({100, 100}, {100, 100}, drop_level);
  EXPECT_EQ(all.estimate, 0.0);
  EXPECT_DOUBLE_EQ(all.low, -none.high);
  EXPECT_DOUBLE_EQ(all.high, -none.low);
  const ProportionDrop everything = proportion_drop({100, 100}, {0, 100}, drop_level);
  EXPECT_EQ(everything.estimate, 1.0);
  EXPECT_GT(everything.low, 0.9);
  EXPECT_EQ(everything.high, 1.0);
  const ProportionDrop single = proportion_drop({1, 1}, {0, 1}, drop_level);
  EXPECT_EQ(single.estimate, 1.0);
  EXPECT_LT(single.low, 0.0);
}

TEST(ProportionDrop, ChangesItsSignWhenTheSamplesAreExchanged) {
  const ProportionDrop drop = proportion_drop({180, 200}, {250, 300}, drop_level);
  const ProportionDrop rise = proportion_drop({250, 300}, {180, 200}, drop_level);
  EXPECT_DOUBLE_EQ(drop.estimate, -rise.estimate);
  EXPECT_DOUBLE_EQ(drop.low, -rise.high);
  EXPECT_DOUBLE_EQ(drop.high, -rise.low);
}

TEST(ProportionDrop, RefusesLevelsThatAreNone) {
  for (const double bad : {0.0, 0.5, -0.1, std::nan("")}) {
    EXPECT_THROW(proportion_drop({1, 2}, {1, 2}, bad), std::invalid_argument) << bad;
  }
  EXPECT_THROW(proportion_drop({3, 2}, {1, 2}, drop_level), std::invalid_argument);
  EXPECT_THROW(proportion_drop({1, 2}, {0, 0}, drop_level), std::invalid_argument);
}

TEST(DetectableDrop, IsFoundWithThePower) {
  for (const double power : {0.6, 0.8, 0.95}) {
    for (const ProportionCount before : {ProportionCount{60, 60}, {300, 400}, {20, 100}}) {
      for (const std::uint64_t trials : {40ULL, 200ULL}) {
        const auto drop = detectable_drop(before, trials, drop_level, power);
        ASSERT_TRUE(drop);
        const double rate = static_cast<double>(before.successes) / static_cast<double>(before.trials) - *drop;
        const std::vector<double> probabilities = binomial_probabilities(trials, rate);
        double found = 0.0;
        for (std::uint64_t x = 0; x <= trials; ++x) {
          if (proportion_drop(before, {x, trials}, drop_level).low > 0.0) found += probabilities[x];
        }
        EXPECT_NEAR(found, power, 1e-9) << before.successes << " of " << before.trials << ", then " << trials;
      }
    }
  }
}

TEST(DetectableDrop, ShrinksWithTheTrials) {
  const ProportionCount before{9000, 10000};
  double last = 1.0;
  for (const std::uint64_t trials : {20ULL, 200ULL, 2000ULL, 20000ULL}) {
    const auto drop = detectable_drop(before, trials, drop_level, 0.8);
    ASSERT_TRUE(drop);
    EXPECT_LT(*drop, last);
    last = *drop;
  }
}

TEST(DetectableDrop, IsNoneWhereNothingWouldShowOne) {
  EXPECT_FALSE(detectable_drop({1, 1}, 1, drop_level, 0.8));
  EXPECT_FALSE(detectable_drop({0, 1000}, 1000, drop_level, 0.8)) << "from nothing there is no drop";
  EXPECT_TRUE(detectable_drop({10, 10}, 10, drop_level, 0.8));
}

TEST(DetectableDrop, RefusesPowersThatAreNone) {
  EXPECT_THROW(detectable_drop({1, 2}, 2, drop_level, 0.5), std::invalid_argument);
  EXPECT_THROW(detectable_drop({1, 2}, 2, drop_level, 1.0), std::invalid_argument);
  EXPECT_THROW(detectable_drop({1, 2}, 0, drop_level, 0.8), std::invalid_argument);
}

}  // namespace
}  // namespace steerstat
