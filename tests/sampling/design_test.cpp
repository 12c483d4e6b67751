#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>
#include <vector>

#include "sampling/factorial.hpp"
#include "sampling/monte_carlo.hpp"

namespace steerstat {
namespace {

TEST(MonteCarlo, AVariablesDrawsDoNotDependOnTheOtherVariables) {
  const std::vector<std::string> few{"plant.m1"};
  const std::vector<std::string> many{"plant.f1", "initial_state.q1", "plant.m1"};
  const MonteCarlo alone(5, few);
  const MonteCarlo among(5, many);
  for (std::uint64_t draw = 0; draw < 100; ++draw) EXPECT_EQ(alone.coordinate(draw, 0), among.coordinate(draw, 2));
}

TEST(MonteCarlo, DrawsDifferBetweenVariablesAndSeeds) {
  const std::vector<std::string> names{"plant.m1", "plant.m2"};
  const MonteCarlo one(1, names);
  const MonteCarlo two(2, names);
  EXPECT_NE(one.coordinate(0, 0), one.coordinate(0, 1));
  EXPECT_NE(one.coordinate(0, 0), two.coordinate(0, 0));
  EXPECT_NE(one.coordinate(0, 0), one.coordinate(1, 0));
}

TEST(Factorial, EveryCombinationIsACellOnce) {
  const Factorial factorial({2, 3, 4});
  ASSERT_EQ(factorial.cells(), 24U);
  std::set<std::array<std::size_t, 3>> seen;
  for (std::uint64_t cell = 0; cell < factorial.cells(); ++cell) {
    const std::array<std::size_t, 3> levels{factorial.level(cell, 0), factorial.level(cell, 1),
                                            factorial.level(cell, 2)};
    EXPECT_LT(levels[0], 2U);
    EXPECT_LT(levels[1], 3U);
    EXPECT_LT(levels[2], 4U);
    seen.insert(levels);
  }
  EXPECT_EQ(seen.size(), 24U);
}

TEST(Factorial, TheLastFactorChangesFastest) {
  const Factorial factorial({2, 3});
  EXPECT_EQ(factorial.level(0, 1), 0U);
  EXPECT_EQ(factorial.level(1, 1), 1U);
  EXPECT_EQ(factorial.level(1, 0), 0U);
  EXPECT_EQ(factorial.level(3, 0), 1U);
  EXPECT_EQ(factorial.level(3, 1), 0U);
}

TEST(Factorial, NoFactorsMakeOneCell) {
  EXPECT_EQ(Factorial({}).cells(), 1U);
}

}  // namespace
}  // namespace steerstat
