#include "sampling/permutation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <vector>

namespace steerstat {
namespace {

std::vector<std::uint64_t> elements_of(const Permutation& permutation, std::uint64_t size) {
  std::vector<std::uint64_t> elements;
  for (std::uint64_t i = 0; i < size; ++i) elements.push_back(permutation.at(i));
  return elements;
}

TEST(Permutation, TakesEveryElementOnceAtEverySizeUpToAHundred) {
  for (std::uint64_t size = 1; size <= 100; ++size) {
    auto elements = elements_of(Permutation(size, 3, "size"), size);
    std::sort(elements.begin(), elements.end());
    for (std::uint64_t i = 0; i < size; ++i) ASSERT_EQ(elements[i], i) << size;
  }
}

TEST(Permutation, TakesEveryElementOnceAroundAPowerOfTwoAndASquare) {
  for (const std::uint64_t size : {4095U, 4096U, 4097U, 9999U, 10000U, 10001U}) {
    std::vector<bool> seen(size);
    const Permutation permutation(size, 1, "large");
    for (std::uint64_t i = 0; i < size; ++i) {
      const std::uint64_t element = permutation.at(i);
      ASSERT_LT(element, size);
      ASSERT_FALSE(seen[element]) << size;
      seen[element] = true;
    }
  }
}

TEST(Permutation, ReachesTheLargestSize) {
  constexpr std::uint64_t size = std::uint64_t{1} << 32U;
  const Permutation permutation(size, 1, "largest");
  std::set<std::uint64_t> seen;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const std::uint64_t element = permutation.at(size - 1 - i);
    EXPECT_LT(element, size);
    seen.insert(element);
  }
  EXPECT_EQ(seen.size(), 1000U);
}

// Chi-square of counts that are expected to be equal; its mean is cells - 1, its variance twice that.
void expect_equal_shares(const std::vector<double>& counts, double total) {
  const auto cells = static_cast<double>(counts.size());
  double chi_square = 0.0;
  for (const double count : counts) chi_square += std::pow(count - total / cells, 2) / (total / cells);
  EXPECT_LT(chi_square, cells - 1.0 + 4.5 * std::sqrt(2.0 * (cells - 1.0)));
}

TEST(Permutation, EveryOrderOfAFewElementsIsEquallyLikely) {
  for (const std::size_t size : {2U, 3U, 4U, 5U}) {
    std::vector<std::uint64_t> order(size);
    for (std::size_t i = 0; i < size; ++i) order[i] = i;
    std::map<std::vector<std::uint64_t>, double> counts;
    do {
      counts[order] = 0.0;
    } while (std::next_permutation(order.begin(), order.end()));
    constexpr std::uint64_t seeds = 6'000;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) ++counts[elements_of(Permutation(size, seed, "order"), size)];
    std::vector<double> shares;
    for (const auto& entry : counts) shares.push_back(entry.second);
    SCOPED_TRACE(size);
    expect_equal_shares(shares, static_cast<double>(seeds));
  }
}

TEST(Permutation, EveryPairOfElementsIsEquallyLikelyAtEveryPairOfPositions) {
  constexpr std::uint64_t size = 12;  // the domain is larger: 4 rows of 3
  constexpr std::uint64_t seeds = 8'000;
  for (const auto& [first, second] : {std::pair{0U, 1U}, std::pair{0U, 3U}, std::pair{5U, 11U}}) {
    std::vector<double> counts(size * (size - 1));
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      const Permutation permutation(size, seed, "pair");
      const std::uint64_t a = permutation.at(first);
      const std::uint64_t b = permutation.at(second);
      ++counts[a * (size - 1) + (b < a ? b : b - 1)];
    }
    expect_equal_shares(counts, static_cast<double>(seeds));
  }
}

TEST(Permutation, OrdersOfDifferentNamesAndSeedsAreUncorrelated) {
  constexpr std::uint64_t size = 10'000;
  const auto correlation = [](const Permutation& a, const Permutation& b) {
    constexpr double middle = 0.5 * (size - 1.0);
    constexpr double variance = (static_cast<double>(size) * size - 1.0) / 12.0;
    double sum = 0.0;
    for (std::uint64_t i = 0; i < size; ++i) {
      sum += (static_cast<double>(a.at(i)) - middle) * (static_cast<double>(b.at(i)) - middle);
    }
    return sum / (variance * size);
  };
  const Permutation one(size, 1, "plant.m1");
  const double bound = 4.5 / std::sqrt(size - 1.0);  // the standard error of a random order's
  EXPECT_LT(std::abs(correlation(one, Permutation(size, 1, "plant.m2"))), bound);
  EXPECT_LT(std::abs(correlation(one, Permutation(size, 2, "plant.m1"))), bound);
}

}  // namespace
}  // namespace steerstat
