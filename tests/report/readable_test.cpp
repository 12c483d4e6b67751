#include "report/readable.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace steerstat {
namespace {

TEST(ReadableCount, GroupsThousands) {
  EXPECT_EQ(readable_count(0), "0");
  EXPECT_EQ(readable_count(999), "999");
  EXPECT_EQ(readable_count(1000), "1,000");
  EXPECT_EQ(readable_count(123456), "123,456");
  EXPECT_EQ(readable_count(1234567), "1,234,567");
  EXPECT_EQ(readable_count(std::numeric_limits<std::uint64_t>::max()), "18,446,744,073,709,551,615");
}

TEST(ReadableShare, TellsOneTrialFromNoneAndFromAllHoweverManyThereAre) {
  for (std::uint64_t trials = 1; trials <= 1'000'000'000; trials = trials * 3 + 1) {
    const double one = 1.0 / static_cast<double>(trials);
    const std::string none = readable_share(0.0, trials);
    const std::string all = readable_share(1.0, trials);
    EXPECT_EQ(none.find_first_of("123456789"), std::string::npos) << none;
    EXPECT_EQ(all.substr(0, 4), "100.") << all;
    EXPECT_NE(readable_share(one, trials), none) << trials;
    EXPECT_TRUE(trials == 1 || readable_share(1.0 - one, trials) != all) << trials;
  }
}

TEST(ReadableShare, ShowsNoMoreDigitsThanTheTrialsCarry) {
  EXPECT_EQ(readable_share(0.4685, 20), "46.9 %");
  EXPECT_EQ(readable_share(0.4685, 2000), "46.85 %");
  EXPECT_EQ(readable_share(0.4685, 100000), "46.8500 %");
}

TEST(ReadableDuration, ChoosesItsUnit) {
  EXPECT_EQ(readable_duration(0.0), "0 ms");
  EXPECT_EQ(readable_duration(0.0001), "1 ms");
  EXPECT_EQ(readable_duration(0.25), "250 ms");
  EXPECT_EQ(readable_duration(0.9999), "1.0 s");
  EXPECT_EQ(readable_duration(7.44), "7.4 s");
  EXPECT_EQ(readable_duration(119.9), "119.9 s");
  EXPECT_EQ(readable_duration(119.96), "2 min 00 s");
  EXPECT_EQ(readable_duration(125.0), "2 min 05 s");
  EXPECT_EQ(readable_duration(3599.4), "59 min 59 s");
  EXPECT_EQ(readable_duration(3599.6), "1 h 00 min");
  EXPECT_EQ(readable_duration(12000.0), "3 h 20 min");
}

TEST(ReadableRate, HasThreeDigitsAtMost) {
  EXPECT_EQ(readable_rate(0.421), "0.42");
  EXPECT_EQ(readable_rate(8.26), "8.3");
  EXPECT_EQ(readable_rate(99.94), "99.9");
  EXPECT_EQ(readable_rate(99.96), "100");
  EXPECT_EQ(readable_rate(271.4), "271");
  EXPECT_EQ(readable_rate(1999.0), "2,000");
  EXPECT_EQ(readable_rate(257412.0), "257,000");
}

TEST(IntervalBar, FillsToTheLowerLimitAndShadesToTheUpper) {
  EXPECT_EQ(interval_bar(0.0, 0.0, 4), "····");
  EXPECT_EQ(interval_bar(1.0, 1.0, 4), "████");
  EXPECT_EQ(interval_bar(0.25, 0.75, 4), "█▒▒·");
}

TEST(Printable, KeepsLettersOfEveryScriptAndReplacesControls) {
  EXPECT_EQ(printable("Überschwingen η₁ 摩擦"), "Überschwingen η₁ 摩擦");
  EXPECT_EQ(printable("a\x1b[31mb\n\x7f"), "a\uFFFD[31mb\uFFFD\uFFFD");
  EXPECT_EQ(printable("a\xc2\x9b"
                      "31mb"),
            "a\uFFFD31mb");                        // the one-byte form of ESC [
  EXPECT_EQ(printable("a\xc2\xa0"), "a\xc2\xa0");  // a space that does not break is none
}

}  // namespace
}  // namespace steerstat
