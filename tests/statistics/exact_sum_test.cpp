#include "statistics/exact_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace steerstat {
namespace {

__extension__ using Integer128 = __int128;

double exact_sum(const std::vector<double>& terms) {
  ExactSum sum;
  for (const double term : terms) sum.add(term);
  return sum.value();
}

TEST(ExactSum, OfNothingIsZero) {
  EXPECT_EQ(ExactSum{}.value(), 0.0);
}

TEST(ExactSum, KeepsWhatCancellationWouldLose) {
  EXPECT_EQ(exact_sum({1e100, 1.0, -1e100}), 1.0);
  EXPECT_EQ(exact_sum({1.0, 1e16, 1e-16, -1e16, -1.0}), 1e-16);
  EXPECT_EQ(exact_sum(std::vector<double>(10, 0.1)), 1.0);  // added one by one: 0.9999999999999999
}

TEST(ExactSum, RoundsHalfUnitsToEvenUnlessASmallerPartDecides) {
  const double two_53 = 0x1p53;  // beyond it, odd integers are half way between doubles
  const double least = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(exact_sum({two_53, 1.0}), two_53);
  EXPECT_EQ(exact_sum({two_53, 1.0, least}), two_53 + 2.0);
  EXPECT_EQ(exact_sum({two_53, 1.0, -least}), two_53);
  EXPECT_EQ(exact_sum({two_53 + 2.0, 1.0}), two_53 + 4.0);
  EXPECT_EQ(exact_sum({two_53 + 2.0, 1.0, -least}), two_53 + 2.0);
  EXPECT_EQ(exact_sum({-two_53, -1.0, -least}), -two_53 - 2.0);
}

TEST(ExactSum, EqualsIntegerArithmeticRoundedOnce) {
  std::mt19937_64 generator(1);
  std::uniform_int_distribution<std::int64_t> integers(-(std::int64_t{1} << 52), std::int64_t{1} << 52);
  std::uniform_int_distribution<int> shifts(0, 40);
  for (int repeat = 0; repeat < 200; ++repeat) {
    Integer128 expected = 0;
    std::vector<double> terms;
    for (int i = 0; i < 300; ++i) {
      const Integer128 term = static_cast<Integer128>(integers(generator)) << shifts(generator);
      expected += term;
      terms.push_back(static_cast<double>(term));  // exact: 53 bits, shifted
    }
    EXPECT_EQ(exact_sum(terms), static_cast<double>(expected));
  }
}

TEST(ExactSum, IsTheSameBitsInEveryOrder) {
  std::mt19937_64 generator(2);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<double> terms;
  for (int i = 0; i < 2000; ++i) terms.push_back(normal(generator) * std::pow(10.0, 20.0 * normal(generator)));
  const double first = exact_sum(terms);
  for (int repeat = 0; repeat < 50; ++repeat) {
    std::shuffle(terms.begin(), terms.end(), generator);
    EXPECT_EQ(exact_sum(terms), first);
  }
}

}  // namespace
}  // namespace steerstat
