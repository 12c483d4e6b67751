#include "sampling/pick_freeze_design.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "sampling/monte_carlo.hpp"

namespace steerstat {
namespace {

TEST(PickFreezeDesign, GivesEachRowAAndBAndAWithEachVariableOfB) {
  const std::vector<std::string> names{"m1", "m2", "f1", "m1'", "m2'", "f1'"};
  const auto base = std::make_shared<MonteCarlo>(4, names);
  const PickFreezeDesign design(base, 3);
  ASSERT_EQ(PickFreezeDesign::variants(3), 5U);
  for (std::uint64_t row = 0; row < 20; ++row) {
    for (std::size_t variable = 0; variable < 3; ++variable) {
      const double a = base->coordinate(row, variable);
      const double b = base->coordinate(row, variable + 3);
      ASSERT_NE(a, b);
      EXPECT_EQ(design.coordinate(5 * row, variable), a);
      EXPECT_EQ(design.coordinate(5 * row + 1, variable), b);
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(design.coordinate(5 * row + 2 + i, variable), i == variable ? b : a);
    }
  }
}

}  // namespace
}  // namespace steerstat
