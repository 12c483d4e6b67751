#include "progress_display.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "process.hpp"

namespace steerstat::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Columns of UTF-8 text without wide characters.
std::size_t columns_of(const std::string& text) {
  std::size_t columns = 0;
  for (const char byte : text) columns += (static_cast<unsigned char>(byte) & 0xc0U) != 0x80U ? 1 : 0;
  return columns;
}

TEST(BarLine, ShowsHowFarHowFastAndHowLong) {
  EXPECT_EQ(bar_line({500, 2000, 2.0}, 80, false),
            " 25 %  ━━━━━━━━───────────────────────────  500 / 2,000 trials  250/s  6 s left");
}

TEST(BarLine, StaysWithinTheTerminalWhateverItsWidth) {
  for (unsigned columns = 0; columns <= 200; ++columns) {
    for (const Progress& progress :
         {Progress{0, 1000000, 0.0}, Progress{999999, 1000000, 86400.0}, Progress{1, 1, 1.0}}) {
      for (const bool stopping : {false, true}) {
        EXPECT_LE(columns_of(bar_line(progress, columns, stopping)), columns > 0 ? columns - 1 : 0);
      }
    }
  }
}

TEST(BarLine, SaysNothingOfRateAndTimeLeftBeforeTheFirstTrial) {
  EXPECT_THAT(bar_line({0, 2000, 1.0}, 80, false), Not(HasSubstr("/s")));
  EXPECT_THAT(bar_line({1, 2000, 1.0}, 80, false), HasSubstr("1.0/s"));
}

TEST(BarLine, IsFullAndAHundredOnlyWhenDone) {
  EXPECT_THAT(bar_line({1999, 2000, 1.0}, 120, false), HasSubstr(" 99 %"));
  EXPECT_THAT(bar_line({1999, 2000, 1.0}, 120, false), HasSubstr("─"));
  EXPECT_THAT(bar_line({2000, 2000, 1.0}, 120, false), HasSubstr("100 %"));
  EXPECT_THAT(bar_line({2000, 2000, 1.0}, 120, false), Not(HasSubstr("─")));
}

TEST(BarLine, RoundsTheTimeLeftUpToSecondsAndThenSaysMinutes) {
  EXPECT_THAT(bar_line({100, 101, 50.0}, 100, false), HasSubstr("  1 s left"));
  EXPECT_THAT(bar_line({100, 338, 50.0}, 100, false), HasSubstr("  119 s left"));
  EXPECT_THAT(bar_line({100, 339, 50.0}, 100, false), HasSubstr("  2 min 00 s left"));
  EXPECT_THAT(bar_line({100, 500, 50.0}, 100, false), HasSubstr("  3 min 20 s left"));
}

TEST(BarLine, SaysThatItIsStopping) {
  EXPECT_THAT(bar_line({500, 2000, 2.0}, 80, true), HasSubstr("stopping"));
  EXPECT_THAT(bar_line({500, 2000, 2.0}, 80, true), Not(HasSubstr("left")));
}

TEST(ProgressSentence, HoldsTheSameFacts) {
  EXPECT_EQ(progress_sentence({500, 2000, 2.0}), "500 / 2,000 trials, 250/s, 6 s left (25 %)");
}

const char* const slow = R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "horizon": 30,
                             "integrator": {"method": "cvode"}, "sampling": {"trials": 200}})";

TEST(ProgressDisplay, RedrawsOneLineOnATerminalAndTakesItOffAtTheEnd) {
  const Scratch scratch;
  Surroundings surroundings;
  surroundings.columns = 60;
  const Ending run = steerstat({"run", scratch.file("spec.json", slow)}, surroundings);
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("100 %"));
  EXPECT_THAT(run.err, Not(HasSubstr("\n")));
  EXPECT_THAT(run.err, ::testing::EndsWith("\r\x1b[K"));
  for (std::size_t begin = 0; begin < run.err.size();) {
    const std::size_t end = std::min(run.err.find('\r', begin + 1), run.err.size());
    std::string drawn = run.err.substr(begin, end - begin);
    drawn = drawn.substr(1, drawn.size() - 4);  // "\r", text, "\x1b[K"
    EXPECT_LT(columns_of(drawn), 60U) << drawn;
    begin = end;
  }
}

TEST(ProgressDisplay, KeepsToPlainLinesWhereNothingCanBeRedrawn) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", slow);
  Surroundings dumb;
  dumb.columns = 80;
  dumb.environment = {"TERM=dumb"};
  EXPECT_THAT(steerstat({"run", spec}, dumb).err, Not(HasSubstr("\x1b")));
  EXPECT_THAT(steerstat({"run", spec}).err, Not(HasSubstr("\x1b")));
}

TEST(ProgressDisplay, CanBeTurnedOff) {
  const Scratch scratch;
  Surroundings surroundings;
  surroundings.columns = 80;
  EXPECT_EQ(steerstat({"run", scratch.file("spec.json", slow), "--no-progress"}, surroundings).err, "");
}

}  // namespace
}  // namespace steerstat::testing
