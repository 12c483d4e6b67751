#include "sampling/stream.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace steerstat {
namespace {

using Block = std::array<std::uint32_t, 4>;

TEST(Philox, MatchesTheKnownAnswersOfRandom123) {
  // philox4x32 10, from Random123's tests/kat_vectors.
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(NameHash, MatchesThePublishedAnswersOfFnv1a) {
  EXPECT_EQ(name_hash(""), 0xcbf29ce484222325U);
  EXPECT_EQ(name_hash("a"), 0xaf63dc4c8601ec8cU);
  EXPECT_EQ(name_hash("foobar"), 0x85944171f73967e8U);
}

TEST(UniformStream, KeepsTheDrawsItHasAlwaysGiven) {
  // Computed by an independent implementation of the keying: a change of any of these changes every study.
  EXPECT_EQ(UniformStream(1, "plant.m1").at(0), 0x1.13e865839a456p-2);
  EXPECT_EQ(UniformStream(1, "plant.m1").at(1), 0x1.137bbed90fbe3p-1);
  EXPECT_EQ(UniformStream(1, "plant.m2").at(0), 0x1.17bf7a8da847dp-1);
  EXPECT_EQ(UniformStream(2, "plant.m1").at(0), 0x1.c62f7af944c7dp-1);
  EXPECT_EQ(UniformStream(0xffffffffffffffffU, "initial_state.q2_dot").at((1ULL << 40U) + 7), 0x1.89bee240712b0p-5);
}

TEST(UnitInterval, StaysStrictlyInsideAtBothEndsAndIsSymmetric) {
  EXPECT_EQ(unit_interval(0), 0x1p-53);
  EXPECT_EQ(unit_interval(0xffffffffffffffffU), 1.0 - 0x1p-53);
  EXPECT_LT(unit_interval(0xffffffffffffffffU), 1.0);
  for (std::uint64_t bits = 12345; bits < (1ULL << 63U); bits = bits * 3 + 1) {
    EXPECT_EQ(1.0 - unit_interval(bits), unit_interval(~bits)) << bits;
  }
}

TEST(UnitInterval, ChangesCellWithTheTwelfthBitAlone) {
  EXPECT_EQ(unit_interval(0xfff), unit_interval(0));
  EXPECT_EQ(unit_interval(0x1000), 3.0 * unit_interval(0));
}

TEST(UniformStream, DrawsAreUniform) {
  constexpr int bins = 100;
  constexpr int draws = 200'000;
  const UniformStream stream(7, "plant.f2");
  std::vector<double> counts(bins);
  for (int i = 0; i < draws; ++i) ++counts[static_cast<std::size_t>(stream.at(static_cast<std::uint64_t>(i)) * bins)];
  double chi_square = 0.0;
  for (const double count : counts) chi_square += std::pow(count - draws / bins, 2) / (draws / bins);
  // Mean 99, variance 198.
  EXPECT_NEAR(chi_square, bins - 1, 4.5 * std::sqrt(2.0 * (bins - 1)));
}

// Correlation of n pairs; its standard error is 1 / sqrt n where the two are independent.
template <class First, class Second>
double correlation(int n, First first, Second second) {
  double sum = 0.0;
  for (int i = 0; i < n; ++i) sum += 12.0 * (first(i) - 0.5) * (second(i) - 0.5);
  return sum / n;
}

TEST(UniformStream, VariablesSeedsAndNeighbouringDrawsAreUncorrelated) {
  constexpr int n = 100'000;
  const double bound = 4.5 / std::sqrt(n);
  const std::vector<UniformStream> streams{{1, "plant.m1"},          {1, "plant.m2"},         {1, "plant.f1"},
                                           {1, "initial_state.q1"},  {1, "initial_state.q2"}, {2, "plant.m1"},
                                           {0x100000001, "plant.m1"}};
  for (std::size_t a = 0; a < streams.size(); ++a) {
    const auto first = [&](int i) { return streams[a].at(static_cast<std::uint64_t>(i)); };
    const auto next = [&](int i) { return streams[a].at(static_cast<std::uint64_t>(i) + 1); };
    EXPECT_LT(std::abs(correlation(n, first, next)), bound) << a;
    for (std::size_t b = a + 1; b < streams.size(); ++b) {
      const auto second = [&](int i) { return streams[b].at(static_cast<std::uint64_t>(i)); };
      EXPECT_LT(std::abs(correlation(n, first, second)), bound) << a << " and " << b;
    }
  }
}

}  // namespace
}  // namespace steerstat
