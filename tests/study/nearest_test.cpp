#include "study/nearest.hpp"

#include <gtest/gtest.h>

#include <array>

namespace steerstat {
namespace {

TEST(EditDistance, CountsInsertionsRemovalsReplacementsAndSwaps) {
  EXPECT_EQ(edit_distance("", ""), 0U);
  EXPECT_EQ(edit_distance("abc", ""), 3U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("trails", "trials"), 1U);
  EXPECT_EQ(edit_distance("ab", "ba"), 1U);
  EXPECT_EQ(edit_distance("M1", "m1"), 0U);
}

TEST(Nearest, FindsTheWordAThirdOfItsLettersAwayAndNoFurther) {
  constexpr std::array<std::string_view, 3> known{"sampling", "sweep", "m1"};
  EXPECT_EQ(nearest("samplign", known), "sampling");
  EXPECT_EQ(nearest("sweeep", known), "sweep");
  EXPECT_EQ(nearest("m", known), "m1");
  EXPECT_EQ(nearest("abcdef", std::array<std::string_view, 1>{"abcdxy"}), "abcdxy");      // 2 of 6
  EXPECT_EQ(nearest("abcdef", std::array<std::string_view, 1>{"abcxyz"}), std::nullopt);  // 3 of 6
  EXPECT_EQ(nearest("horizon", known), std::nullopt);
}

TEST(Nearest, PrefersTheNearestOfSeveral) {
  constexpr std::array<std::string_view, 3> known{"eta2x", "eta22", "eta1"};
  EXPECT_EQ(nearest("eta11", known), "eta1");
}

TEST(Nearest, WordsOfOtherLengthsAreStillCompared) {
  EXPECT_EQ(nearest("retention", std::array<std::string_view, 1>{"retent"}), "retent");       // 3 of 9
  EXPECT_EQ(nearest("retentions", std::array<std::string_view, 1>{"retent"}), std::nullopt);  // 4 of 10
}

TEST(Nearest, GivesUpOnAnEndlessWord) {
  EXPECT_EQ(nearest(std::string(100'000, 'a'), std::array<std::string_view, 1>{"a"}), std::nullopt);
}

}  // namespace
}  // namespace steerstat
