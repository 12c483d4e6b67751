#include "report/markdown.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sample_summary.hpp"

namespace steerstat {
namespace {

using namespace testing_report;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST(SummaryMarkdown, BeginsWithTheWorstVerdictAndTheGates) {
  Summary summary = made_up_summary({700, 300, 0, 0, 0});
  summary.gates = {
      {"success_rate", "ci_low > 0.6", {}, 0.67, {0.67, 0.73}, Verdict::pass, "all of the interval"},
      {"settling_time", "p95 < 9", {{"plant.m1", 0.5}}, std::nullopt, {}, Verdict::inconclusive, "no data"}};
  const std::string text = summary_markdown(summary);
  EXPECT_THAT(text, StartsWith("## sample: ⚠️ inconclusive\n\n| Verdict | Gate |"));
  EXPECT_THAT(text,
              HasSubstr("| ✅ pass | `success_rate ci_low > 0.6` | 0.67 | 0.67 to 0.73 | all of the interval |\n"));
  EXPECT_THAT(text,
              HasSubstr("| ⚠️ inconclusive | `settling_time p95 < 9 (plant.m1 = 0.5)` | – | – | no data |\n"));
  summary.gates[1].verdict = Verdict::fail;
  EXPECT_THAT(summary_markdown(summary), StartsWith("## sample: ❌ fail\n"));
}

TEST(SummaryMarkdown, TellsTheRateTheOutcomesAndTheMetrics) {
  const std::string text = summary_markdown(made_up_summary({700, 300, 0, 0, 0}));
  EXPECT_THAT(text, StartsWith("## sample\n"));
  EXPECT_THAT(text, HasSubstr("Success rate **70.00 %**, 95 % interval 67.09 % to 72.76 %, 1,000 trials"));
  EXPECT_THAT(text, HasSubstr("| `timeout` | 300 | 30.00 % |"));
  EXPECT_THAT(text, HasSubstr("| `diverged` | 0 | – |"));
  EXPECT_THAT(text, HasSubstr("| `settling_time` | `s` | 700 | 3505 |"));
  EXPECT_THAT(text, Not(HasSubstr("position_contraction_worst"))) << "without data";
  EXPECT_THAT(summary_markdown(made_up_summary({1, 0, 0, 0, 0})), HasSubstr(", 1 trial\n"));
}

TEST(SummaryMarkdown, OfNoTrialSaysSo) {
  Summary summary = made_up_summary({0, 0, 0, 0, 0});
  summary.complete = false;
  summary.requested = 100;
  const std::string text = summary_markdown(summary);
  EXPECT_THAT(text, HasSubstr("**Incomplete**: 0 of 100 trials finished"));
  EXPECT_THAT(text, Not(HasSubstr("nan")));
}

TEST(SummaryMarkdown, ShowsANameAsItIs) {
  Summary summary = made_up_summary({7, 3, 0, 0, 0});
  summary.name = "a|b <img> `c` *d* [e](f)\n## g & \\ @h";
  const std::string title = summary_markdown(summary).substr(0, summary_markdown(summary).find('\n'));
  EXPECT_EQ(title,
            "## a&#124;b &#60;img&#62; &#96;c&#96; &#42;d&#42; &#91;e&#93;(f)\uFFFD&#35;&#35; g &#38; &#92; &#64;h");
}

TEST(SummaryMarkdown, OfManyCellsShowsTheFirst) {
  const std::string text = summary_markdown(made_up_sweep(60));
  EXPECT_THAT(text, HasSubstr("| `controller.contraction.eta1 = 0.049` |"));
  EXPECT_THAT(text, Not(HasSubstr("`controller.contraction.eta1 = 0.05`")));
  EXPECT_THAT(text, HasSubstr("The first 50 of 60 cells."));
}

}  // namespace
}  // namespace steerstat
