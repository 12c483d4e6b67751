#include "report/comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "json_text.hpp"
#include "sample_comparison.hpp"

namespace steerstat {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using testing_report::drawn_spec;
using testing_report::Finished;
using testing_report::finished;

/// A study of as many trials as there are end times; one at 0 timed out, the others converged then.
Finished ended_at(const std::vector<double>& end_times, const std::string& more = "") {
  Finished made = finished(drawn_spec(static_cast<int>(end_times.size()), more));
  for (std::size_t i = 0; i < end_times.size(); ++i) {
    TrialOutcome& outcome = made.result.trials.outcomes[i];
    outcome.status = end_times[i] > 0.0 ? Status::converged : Status::timeout;
    outcome.end_time = end_times[i] > 0.0 ? end_times[i] : 300.0;
  }
  return made;
}

TEST(Compare, CountsPairsAndTakesDifferencesOfBLessA) {
  const Finished a = ended_at({10, 20, 30, 0, 0, 40});
  const Finished b = ended_at({11, 18, 0, 25, 0, 47}, R"(, "horizon": 200)");
  const Comparison comparison = compare(a.compared(), b.compared());
  EXPECT_EQ(comparison.all.counts, (PairedCounts{3, 1, 1, 1}));
  EXPECT_EQ(comparison.all.success_rate_difference->estimate, 0.0);
  ASSERT_TRUE(comparison.all.settling_time_difference);
  const SettlingTimeDifference& settling = *comparison.all.settling_time_difference;  // of +1, -2, +7
  EXPECT_EQ(settling.pairs, 3U);
  EXPECT_EQ(settling.sample.mean, 2.0);
  EXPECT_EQ(settling.sample.p50, 1.0);
  EXPECT_EQ(settling.sample.min, -2.0);
  // Student's t with two degrees of freedom, standard deviation sqrt(21).
  EXPECT_NEAR(*settling.mean.high, 2.0 + 4.302652729911275 * std::sqrt(7.0), 1e-9);
  EXPECT_FALSE(settling.median.low) << "three values bound no median at 95 %";
  EXPECT_THAT(comparison.a_only.indices, ElementsAre(2));
  EXPECT_THAT(comparison.b_only.indices, ElementsAre(3));
  EXPECT_THAT(comparison.differences, ElementsAre(SpecDifference{"/horizon", "300", "200"}));
  EXPECT_THAT(comparison.drawn, ElementsAre("plant.m1", "plant.f2"));
  EXPECT_THAT(comparison.warnings, IsEmpty());
  EXPECT_THAT(comparison.cells, IsEmpty());
}

TEST(Compare, MirrorsWhenAAndBSwap) {
  const Finished a = finished(drawn_spec(200), 1);
  const Finished b = finished(drawn_spec(200), 2);
  const Comparison one = compare(a.compared(), b.compared());
  const Comparison other = compare(b.compared(), a.compared());
  EXPECT_EQ(one.all.counts.a_only, other.all.counts.b_only);
  EXPECT_EQ(one.all.test->p_value, other.all.test->p_value);
  EXPECT_EQ(one.all.success_rate_difference->low, -other.all.success_rate_difference->high);
  EXPECT_EQ(one.all.settling_time_difference->sample.mean, -other.all.settling_time_difference->sample.mean);
  EXPECT_EQ(one.a_only.indices, other.b_only.indices);
}

TEST(Compare, AStudyWithItselfHasNoDiscordAndAnIntervalAroundNought) {
  const Finished a = finished(drawn_spec(100));
  const Comparison comparison = compare(a.compared(), a.compared());
  EXPECT_EQ(comparison.all.counts.a_only + comparison.all.counts.b_only, 0U);
  EXPECT_EQ(comparison.all.test->p_value, 1.0);
  EXPECT_LT(comparison.all.success_rate_difference->low, 0.0);
  EXPECT_GT(comparison.all.success_rate_difference->high, 0.0);
  EXPECT_THAT(comparison.warnings, ElementsAre(HasSubstr("the specs do not differ")));
}

TEST(Compare, GivesEachCellItsTestAndAllCellsTogetherNone) {
  const std::string sweep = R"(, "controller": {"contraction": {"eta1": {"sweep": [0.3, 0.5, 0.6]}}})";
  const Finished a = finished(drawn_spec(150, sweep), 1);
  const Finished b = finished(drawn_spec(150, sweep), 2);
  const Comparison comparison = compare(a.compared(), b.compared());
  EXPECT_EQ(comparison.all.counts.pairs(), 450U);
  EXPECT_FALSE(comparison.all.test);
  EXPECT_FALSE(comparison.all.success_rate_difference);
  EXPECT_FALSE(comparison.all.settling_time_difference->mean.low);
  ASSERT_THAT(comparison.cells, SizeIs(3));
  std::uint64_t discordant = 0;
  for (const Comparison::Cell& cell : comparison.cells) {
    EXPECT_EQ(cell.statistics.counts.pairs(), 150U);
    EXPECT_GE(*cell.statistics.holm_p_value, cell.statistics.test->p_value);
    discordant += cell.statistics.counts.a_only;
  }
  EXPECT_EQ(comparison.cells[2].sweep.front().value, 0.6);
  EXPECT_EQ(comparison.all.counts.a_only, discordant);
}

TEST(Compare, WarnsOfOtherEnginesInterruptedRunsAndLeftOverTrials) {
  Finished a = finished(drawn_spec(40));
  Finished b = finished(drawn_spec(1500, R"(, "horizon": 100)"));
  testing_report::keep_trials(a, [](std::uint64_t index) { return index < 30; });
  const Comparison comparison = compare(a.compared("0.1.0"), b.compared("0.2.0"));
  EXPECT_THAT(
      comparison.warnings,
      ElementsAre(HasSubstr("A was run by engine 0.1.0, B by 0.2.0"), HasSubstr("A is incomplete: 30 of 40 trials"),
                  HasSubstr("only the 30 trials that both have are paired (A has 30, B 1,500)")));
}

TEST(ComparisonJson, HasNullWhereThereIsNoData) {
  const Finished a = ended_at({0, 0});
  const auto json = testing::json_of(comparison_json(compare(a.compared(), a.compared())));
  EXPECT_TRUE(json.at("settling_time_difference").is_null());
  EXPECT_EQ(json.at("pairs").at("neither"), 2);
  EXPECT_EQ(json.at("success_rate").at("difference").at("estimate"), 0.0);
  EXPECT_EQ(json.at("mcnemar").at("p_value"), 1.0);
  EXPECT_TRUE(json.at("mcnemar").at("holm_p_value").is_null());
  EXPECT_EQ(json.at("discordant").at("a_only").at("count"), 0);
}

TEST(ComparisonJson, ListsDiscordantTrialsUpToItsCapAndCountsThemAll) {
  Comparison comparison = compare(ended_at({10}).compared(), ended_at({10}).compared());
  const int trials = static_cast<int>(most_discordant_indices) + 1;
  Finished a = finished(drawn_spec(trials));
  Finished b = a;
  for (TrialOutcome& outcome : a.result.trials.outcomes) outcome.status = Status::converged;
  for (TrialOutcome& outcome : b.result.trials.outcomes) outcome.status = Status::timeout;
  comparison = compare(a.compared(), b.compared());
  EXPECT_EQ(comparison.a_only.count, most_discordant_indices + 1);
  EXPECT_THAT(comparison.a_only.indices, SizeIs(most_discordant_indices));
}

TEST(ComparisonText, SaysWhatDiffersHowSureItIsAndHowToReplay) {
  const Finished a = ended_at({10, 20, 30, 0, 0, 40});
  const Finished b = ended_at({11, 18, 0, 25, 0, 47}, R"(, "horizon": 200)");
  const std::string text = comparison_text(compare(a.compared(), b.compared()), "a.h5", "the b.h5", 5, false);
  for (const char* part :
       {"/horizon", "300", "200", "6 pairs", "Tango", "McNemar's exact test p = 1.0000", "mean +2.00",
        "A alone converged in 1 pair", "steerstat replay a.h5 --trial 2", "# and of 'the b.h5'"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
}

TEST(ComparisonText, ListsNoMoreThanAskedForAndNothingThatSteersTheTerminal) {
  const Finished a = ended_at({10, 20, 30, 40});
  const Finished b = ended_at({0, 0, 0, 0});
  const Comparison comparison = compare(a.compared(), b.compared());
  const std::string two = comparison_text(comparison, "a\x1b[2J.h5", "b.h5", 2, false);
  EXPECT_THAT(two, HasSubstr("--trial 1 "));
  EXPECT_THAT(two, Not(HasSubstr("--trial 2 ")));
  EXPECT_THAT(two, HasSubstr("2 more"));
  EXPECT_THAT(two, Not(HasSubstr("\x1b")));
  EXPECT_THAT(comparison_text(comparison, "a.h5", "b.h5", 0, false), Not(HasSubstr("--trial ")));
}

}  // namespace
}  // namespace steerstat
