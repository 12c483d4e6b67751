#include "study/precision_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "statistics/confidence_sequence.hpp"
#include "statistics/sample.hpp"

namespace steerstat {
namespace {

TrialOutcome settled(double time) {
  TrialOutcome outcome;
  outcome.status = Status::converged;
  outcome.end_time = time;
  return outcome;
}

TrialOutcome timed_out() {
  TrialOutcome outcome;
  outcome.status = Status::timeout;
  outcome.end_time = 300.0;
  return outcome;
}

/// Trials of which one in five times out and the others settle within some hundred seconds.
std::vector<TrialOutcome> made_up_trials(std::size_t count, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::bernoulli_distribution converges(0.8);
  std::lognormal_distribution<double> times(4.5, 0.4);
  std::vector<TrialOutcome> outcomes;
  while (outcomes.size() < count) {
    const double time = times(generator);
    outcomes.push_back(converges(generator) ? settled(time) : timed_out());
  }
  return outcomes;
}

StopReport after(PrecisionWatch watch, const std::vector<TrialOutcome>& outcomes) {
  for (const TrialOutcome& outcome : outcomes) watch.add(outcome);
  return watch.report();
}

PrecisionGoal rate_within(double half_width) {
  return {"success_rate", std::nullopt, half_width, false};
}

PrecisionGoal median_within(double half_width) {
  return {"settling_time", 0.5, half_width, false};
}

TEST(PrecisionWatch, LooksAfterTheFirstDrawsThenAfterEveryFewMoreAndAfterTheLast) {
  const StopRule never{30, 20, 0.95, {rate_within(1e-6)}};
  const std::vector<TrialOutcome> trials = made_up_trials(100, 1);
  for (const auto& [taken, looks] : {std::pair{29U, 0U}, {30U, 1U}, {49U, 1U}, {50U, 2U}, {99U, 4U}, {100U, 5U}}) {
    const StopReport report = after(PrecisionWatch(never, 100, 1), {trials.begin(), trials.begin() + taken});
    EXPECT_EQ(report.looks, looks) << taken;
    EXPECT_EQ(report.trials, taken);
    EXPECT_EQ(report.reason.has_value(), taken == 100) << taken;
  }
  EXPECT_EQ(after(PrecisionWatch(never, 100, 1), trials).reason, StopReason::max_trials);
}

TEST(PrecisionWatch, LooksOnceWhereTheFirstLookIsTheLast) {
  const StopReport report = after(PrecisionWatch({100, 7, 0.95, {rate_within(1e-6)}}, 100, 1), made_up_trials(100, 1));
  EXPECT_EQ(report.looks, 1U);
  EXPECT_EQ(report.reason, StopReason::max_trials);
}

TEST(PrecisionWatch, StopsAtTheFirstLookWhereTheRateIsPreciseEnough) {
  const std::vector<TrialOutcome> trials = made_up_trials(5000, 2);
  const StopReport report = after(PrecisionWatch({100, 50, 0.95, {rate_within(0.05)}}, 5000, 1), trials);
  std::uint64_t successes = 0;
  std::uint64_t expected = 0;
  std::uint64_t looks = 0;
  for (std::uint64_t n = 1; expected == 0; ++n) {
    successes += trials[n - 1].status == Status::converged ? 1U : 0U;
    if (n < 100 || n % 50 != 0) continue;
    ++looks;
    const ProportionInterval interval = confidence_sequence(successes, n, 0.95);
    if (interval.high - interval.low > 0.1) continue;
    expected = n;
    EXPECT_EQ(report.goals[0].low, interval.low);
    EXPECT_EQ(report.goals[0].high, interval.high);
    EXPECT_EQ(report.goals[0].estimate, interval.estimate);
  }
  EXPECT_EQ(report.trials, expected);
  EXPECT_EQ(report.looks, looks);
  EXPECT_EQ(report.reason, StopReason::precision_reached);
  EXPECT_TRUE(report.goals[0].reached);
}

TEST(PrecisionWatch, JudgesAQuantileOfTheTrialsThatHaveTheMetric) {
  const std::vector<TrialOutcome> trials = made_up_trials(5000, 3);
  const StopReport report = after(PrecisionWatch({100, 50, 0.9, {median_within(6.0)}}, 5000, 1), trials);
  ASSERT_EQ(report.reason, StopReason::precision_reached);
  const auto interval_of = [&](std::uint64_t n) {
    std::vector<double> times;
    for (std::uint64_t i = 0; i < n; ++i) {
      if (trials[i].status == Status::converged) times.push_back(trials[i].end_time);
    }
    std::sort(times.begin(), times.end());
    return std::pair(quantile_confidence_sequence(times, 0.5, 0.9), quantile(times, 0.5));
  };
  const auto [now, median] = interval_of(report.trials);
  EXPECT_EQ(report.goals[0].low, now.low);
  EXPECT_EQ(report.goals[0].high, now.high);
  EXPECT_EQ(report.goals[0].estimate, median);
  EXPECT_LE(*now.high - *now.low, 12.0);
  const auto [before, _] = interval_of(report.trials - 50);
  EXPECT_GT(*before.high - *before.low, 12.0);
}

TEST(PrecisionWatch, StopsWhenTheLastOfItsGoalsHolds) {
  const std::vector<TrialOutcome> trials = made_up_trials(5000, 4);
  const auto stop = [&](std::vector<PrecisionGoal> goals) {
    return after(PrecisionWatch({50, 50, 0.95, std::move(goals)}, 5000, 1), trials).trials;
  };
  const std::uint64_t rate = stop({rate_within(0.05)});
  const std::uint64_t median = stop({median_within(5.0)});
  EXPECT_NE(rate, median);
  EXPECT_EQ(stop({rate_within(0.05), median_within(5.0)}), std::max(rate, median));
}

TEST(PrecisionWatch, StopsWhenTheGoalHoldsInTheLastOfTheCells) {
  // In the cell 0 everything converges, in cell 1 four in five do.
  const std::vector<TrialOutcome> varied = made_up_trials(3000, 5);
  std::vector<TrialOutcome> trials;
  for (const TrialOutcome& outcome : varied) {
    trials.push_back(settled(60.0));
    trials.push_back(outcome);
  }
  const StopRule rule{50, 50, 0.95, {rate_within(0.05)}};
  const StopReport alone = after(PrecisionWatch(rule, 3000, 1), varied);
  const StopReport both = after(PrecisionWatch(rule, 3000, 2), trials);
  ASSERT_EQ(both.reason, StopReason::precision_reached);
  EXPECT_EQ(both.trials, 2 * alone.trials);
  EXPECT_EQ(both.looks, alone.looks);
  EXPECT_EQ(both.goals[0].cell, 1U) << "the one that is farthest from its goal";
  EXPECT_EQ(both.goals[0].low, alone.goals[0].low);
}

TEST(PrecisionWatch, TakesARelativeWidthAsAShareOfTheEstimate) {
  const std::vector<TrialOutcome> trials = made_up_trials(5000, 6);
  PrecisionGoal relative = median_within(0.06);
  relative.relative = true;
  const StopReport report = after(PrecisionWatch({50, 50, 0.95, {relative}}, 5000, 1), trials);
  ASSERT_EQ(report.reason, StopReason::precision_reached);
  const GoalProgress& goal = report.goals[0];
  EXPECT_LE((*goal.high - *goal.low) / 2.0, 0.06 * *goal.estimate);
}

TEST(PrecisionWatch, NeverCallsTheSettlingTimePreciseWhereNothingConverges) {
  const std::vector<TrialOutcome> trials(500, timed_out());
  const StopReport report =
      after(PrecisionWatch({10, 10, 0.95, {median_within(1e9), rate_within(0.1)}}, 500, 1), trials);
  EXPECT_EQ(report.reason, StopReason::max_trials);
  EXPECT_FALSE(report.goals[0].reached);
  EXPECT_FALSE(report.goals[0].estimate || report.goals[0].low || report.goals[0].high);
  EXPECT_TRUE(report.goals[1].reached);
}

TEST(PrecisionWatch, CallsPrecisionReachedAtTheLastLookReached) {
  const std::vector<TrialOutcome> trials = made_up_trials(5000, 7);
  const StopRule rule{100, 100, 0.95, {rate_within(0.05)}};
  const std::uint64_t needed = after(PrecisionWatch(rule, 5000, 1), trials).trials;
  EXPECT_EQ(after(PrecisionWatch(rule, needed, 1), trials).reason, StopReason::precision_reached);
  EXPECT_EQ(after(PrecisionWatch(rule, needed - 100, 1), trials).reason, StopReason::max_trials);
}

TEST(PrecisionWatch, TakesNothingOnceItHasStopped) {
  PrecisionWatch watch({10, 10, 0.95, {rate_within(0.4)}}, 100, 1);
  for (int i = 0; i < 100; ++i) watch.add(settled(50.0));
  EXPECT_TRUE(watch.stopped());
  EXPECT_EQ(watch.report().trials, 10U);
}

TEST(PrecisionWatch, OfNoTrialKnowsNothing) {
  const StopReport report = PrecisionWatch({10, 10, 0.95, {rate_within(0.4), median_within(1.0)}}, 100, 3).report();
  EXPECT_EQ(report.trials, 0U);
  EXPECT_FALSE(report.reason);
  for (const GoalProgress& goal : report.goals) EXPECT_FALSE(goal.reached || goal.estimate || goal.low || goal.high);
}

}  // namespace
}  // namespace steerstat
