#include "sampling/metropolis_candidates.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/normal.hpp"
#include "sampling/monte_carlo.hpp"

namespace steerstat {
namespace {

const std::vector<std::string> two_names{"a", "b"};

TEST(MetropolisCandidates, AreAPureFunctionOfIndexAndState) {
  const MetropolisCandidates candidates(3, two_names);
  const std::vector<double> state{0.2, 0.9};
  std::vector<double> first(2);
  std::vector<double> other(2);
  std::vector<double> again(2);
  candidates.place(5, state, first);
  candidates.place(6, state, other);
  MetropolisCandidates(3, two_names).place(5, state, again);
  EXPECT_EQ(first, again);
  EXPECT_NE(first, other);
}

TEST(MetropolisCandidates, MoveByOneStandardDeviationAtMostOrKeepTheirBits) {
  const MetropolisCandidates candidates(3, two_names);
  const std::vector<double> state{0.001, 0.97};
  std::vector<double> candidate(2);
  int moved = 0;
  constexpr int tries = 4000;
  for (std::uint64_t i = 0; i < tries; ++i) {
    candidates.place(i, state, candidate);
    for (std::size_t k = 0; k < 2; ++k) {
      if (candidate[k] == state[k]) continue;
      ++moved;
      ASSERT_LE(std::abs(normal_quantile(candidate[k]) - normal_quantile(state[k])), 1.0 + 1e-12);
    }
  }
  EXPECT_GT(moved, tries / 2);
  EXPECT_LT(moved, 2 * tries);
}

TEST(MetropolisCandidates, StayInsideTheUnitCubeAtItsCorners) {
  const MetropolisCandidates candidates(3, two_names);
  std::vector<double> state{0x1p-53, 1.0 - 0x1p-53};
  for (std::uint64_t i = 0; i < 2000; ++i) {
    candidates.place(i, state, state);
    for (const double u : state) {
      ASSERT_GT(u, 0.0);
      ASSERT_LT(u, 1.0);
    }
  }
}

// Of states that are uniform, so are the candidates: the chains' distribution is that of the draws.
TEST(MetropolisCandidates, KeepTheDistribution) {
  const MonteCarlo draws(9, two_names);
  const MetropolisCandidates candidates(10, two_names);
  constexpr std::uint64_t n = 40'000;
  std::vector<std::vector<double>> shares(2, std::vector<double>(10));
  std::vector<double> state(2);
  for (std::uint64_t i = 0; i < n; ++i) {
    draws.place(i, state);
    for (std::uint64_t step = 0; step < 3; ++step) candidates.place(3 * i + step, state, state);
    for (std::size_t k = 0; k < 2; ++k) shares[k][static_cast<std::size_t>(10.0 * state[k])] += 1.0 / n;
  }
  for (const auto& of_variable : shares) {
    for (const double share : of_variable) EXPECT_NEAR(share, 0.1, 4.5 * std::sqrt(0.1 * 0.9 / n));
  }
}

}  // namespace
}  // namespace steerstat
