#include "sampling/nested_scrambling.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace steerstat {
namespace {

constexpr unsigned digits = SobolSequence::digits;
constexpr unsigned extra = NestedScrambling::digits - digits;

// How many leading digits two numbers of `length` digits share.
unsigned shared(std::uint64_t a, std::uint64_t b, unsigned length) {
  return length - static_cast<unsigned>(std::bit_width(a ^ b));
}

TEST(NestedScrambling, KeepsHowManyLeadingDigitsTwoNumbersShare) {
  const NestedScrambling scrambling(4, "x");
  const std::uint64_t base = 0x2'9abc'def1U;
  for (unsigned digit = 0; digit < digits; ++digit) {
    const std::uint64_t other = base ^ (std::uint64_t{1} << digit);
    EXPECT_EQ(shared(scrambling.scramble(base) >> extra, scrambling.scramble(other) >> extra, digits),
              shared(base, other, digits));
  }
}

TEST(NestedScrambling, IsOneToOne) {
  const NestedScrambling scrambling(4, "x");
  std::set<std::uint64_t> images;
  for (std::uint64_t leading = 0; leading < 4096; ++leading) {
    images.insert(scrambling.scramble(leading << (digits - 12)) >> (NestedScrambling::digits - 12));
  }
  EXPECT_EQ(images.size(), 4096U);
}

// Whether digit `depth` of the number is flipped.
bool is_flipped(const NestedScrambling& scrambling, std::uint64_t number, unsigned depth) {
  const std::uint64_t image = scrambling.scramble(number) >> extra;
  return (((image ^ number) >> (digits - 1 - depth)) & 1U) != 0;
}

TEST(NestedScrambling, AFlipDependsOnTheDigitsBeforeAlone) {
  const NestedScrambling scrambling(4, "x");
  const std::uint64_t number = 0x3'1415'9265U;
  for (unsigned depth = 0; depth < digits; ++depth) {
    const std::uint64_t from_here_on = (std::uint64_t{1} << (digits - depth)) - 1;
    EXPECT_EQ(is_flipped(scrambling, number, depth), is_flipped(scrambling, number ^ from_here_on, depth));
    EXPECT_EQ(is_flipped(scrambling, number, depth), is_flipped(scrambling, number & ~from_here_on, depth));
  }
}

// The bits of any two nodes are independent fair coins over seeds: each pair comes up in a quarter of the seeds.
void expect_independent_coins(const std::vector<std::pair<std::uint64_t, unsigned>>& nodes) {
  constexpr std::size_t seeds = 4000;
  std::vector<std::vector<bool>> flips(nodes.size());
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const NestedScrambling scrambling(seed, "coins");
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      flips[i].push_back(is_flipped(scrambling, nodes[i].first, nodes[i].second));
    }
  }
  const double bound = 5.0 * std::sqrt(seeds);  // the worst of some hundreds exceeds it once in 3,000 samples
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    double sum = 0.0;
    for (std::size_t seed = 0; seed < seeds; ++seed) sum += flips[i][seed] ? 1.0 : -1.0;
    EXPECT_LT(std::abs(sum), bound) << i;
    for (std::size_t j = i + 1; j < nodes.size(); ++j) {
      double product = 0.0;
      for (std::size_t seed = 0; seed < seeds; ++seed) product += flips[i][seed] == flips[j][seed] ? 1.0 : -1.0;
      EXPECT_LT(std::abs(product), bound) << i << " and " << j;
    }
  }
}

TEST(NestedScrambling, FlipsOfAllNodesOfTheFirstLevelsAreIndependentFairCoins) {
  std::vector<std::pair<std::uint64_t, unsigned>> nodes;
  for (unsigned depth = 0; depth < 4; ++depth) {
    for (std::uint64_t prefix = 0; prefix < std::uint64_t{1} << depth; ++prefix) {
      nodes.emplace_back(prefix << (digits - depth), depth);
    }
  }
  expect_independent_coins(nodes);
}

TEST(NestedScrambling, FlipsAlongAPathAndBesideItAreIndependentFairCoins) {
  std::vector<std::pair<std::uint64_t, unsigned>> nodes;
  const std::uint64_t number = 0x5'a5a5'a5a5U;
  for (unsigned depth = 0; depth < digits; depth += 2) {
    nodes.emplace_back(number, depth);
    if (depth > 0) nodes.emplace_back(number ^ (std::uint64_t{1} << (digits - depth)), depth);  // the sibling
  }
  expect_independent_coins(nodes);
}

TEST(NestedScrambling, DigitsThatFollowAreUniform) {
  const NestedScrambling scrambling(4, "x");
  std::vector<double> counts(16);
  constexpr double n = 32'000;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(n); ++i) {
    ++counts[(scrambling.scramble(i * 7919) >> (extra - 4)) & 15U];
  }
  double chi_square = 0.0;
  for (const double count : counts) chi_square += std::pow(count - n / 16.0, 2) / (n / 16.0);
  EXPECT_LT(chi_square, 15.0 + 4.5 * std::sqrt(30.0));
}

TEST(NestedScrambling, NamesAndSeedsScrambleDifferently) {
  std::set<std::uint64_t> images;
  for (const char* name : {"plant.m1", "plant.m2"}) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) images.insert(NestedScrambling(seed, name).scramble(0));
  }
  EXPECT_EQ(images.size(), 20U);
}

}  // namespace
}  // namespace steerstat
