#include "view/comparison_view.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "../report/sample_comparison.hpp"
#include "json_text.hpp"

namespace steerstat {
namespace {

using Json = nlohmann::json;
using testing_report::drawn_spec;
using testing_report::finished;
using testing_report::Finished;

struct Two {
  Finished a, b;
  [[nodiscard]] ComparisonView view() const { return comparison_view(a.compared(), b.compared()); }
};

Two two(int trials) {
  return {finished(drawn_spec(trials), 1), finished(drawn_spec(trials, R"(, "horizon": 100)"), 2)};
}

TEST(ComparisonView, DistributionsAreOfThePairsThatTheTableCounts) {
  const ComparisonView view = two(800).view();
  const PairedCounts& counts = view.comparison.all.counts;
  EXPECT_EQ(view.a.trials, counts.both + counts.a_only);
  EXPECT_EQ(view.b.trials, counts.both + counts.b_only);
  EXPECT_EQ(view.difference.trials, counts.both);
  EXPECT_TRUE(view.a.band);
  EXPECT_EQ(view.difference.x.front(), view.comparison.all.settling_time_difference->sample.min);
  EXPECT_EQ(view.difference.x.back(), view.comparison.all.settling_time_difference->sample.max);
}

TEST(ComparisonView, ListsTheDiscordantTrialsOfTheComparison) {
  const ComparisonView view = two(300).view();
  const ComparisonView::Discordant& discordant = view.discordant;
  EXPECT_EQ(discordant.index.size(), view.comparison.a_only.count + view.comparison.b_only.count);
  EXPECT_TRUE(std::is_sorted(discordant.index.begin(), discordant.index.end()));
  ASSERT_EQ(view.inputs.size(), 2U);
  for (std::size_t i = 0; i < discordant.index.size(); ++i) {
    EXPECT_NE(discordant.status_a[i] == Status::converged, discordant.status_b[i] == Status::converged);
    EXPECT_GT(discordant.inputs[0][i], 0.8);
  }
}

TEST(ComparisonView, HasAtMostAThousandDiscordantTrialsEachWayAndTheirWholeCount) {
  Two pair = two(5000);
  for (TrialOutcome& outcome : pair.a.result.trials.outcomes) outcome.status = Status::converged;
  for (TrialOutcome& outcome : pair.b.result.trials.outcomes) outcome.status = Status::timeout;
  const ComparisonView view = pair.view();
  EXPECT_EQ(view.comparison.a_only.count, 5000U);
  EXPECT_EQ(view.comparison.a_only.indices.size(), most_shown_discordant);
  EXPECT_EQ(view.discordant.index.size(), most_shown_discordant);
  EXPECT_EQ(view.b.trials, 0U);
  const Json json = testing::json_of(comparison_view_json(view));
  EXPECT_EQ(json["comparison"]["discordant"]["a_only"]["count"], 5000);
  EXPECT_EQ(json["settling_time"]["b"]["band_note"], "there are no trials");
}

TEST(ComparisonView, RefusesStudiesThatDoNotPair) {
  Two pair = two(20);
  pair.b = finished(R"({"plant": {"m1": {"uniform": [0.8, 1.3]}}, "sampling": {"trials": 20}})");
  EXPECT_THROW(pair.view(), StudiesDoNotPair);
}

}  // namespace
}  // namespace steerstat
