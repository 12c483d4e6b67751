#include "view/narrowing.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "../report/sample_comparison.hpp"
#include "report/summary.hpp"

namespace steerstat {
namespace {

using testing_report::drawn_spec;
using testing_report::finished;
using testing_report::Finished;

Narrowing narrowing(const Finished& made) {
  return narrowing_of({made.study, made.result, made.parameters});
}

TEST(Narrowing, EndsWithTheSummarysSuccessRate) {
  const Finished made = finished(drawn_spec(3000));
  const Narrowing narrowed = narrowing(made);
  const Summary summary = summarise(made.study, made.result);
  EXPECT_EQ(narrowed.of, 3000U);
  EXPECT_EQ(narrowed.trials.back(), 3000U);
  EXPECT_EQ(narrowed.estimate.back(), summary.all.success_rate->estimate);
  EXPECT_EQ(narrowed.low.back(), summary.all.success_rate->low);
  EXPECT_EQ(narrowed.high.back(), summary.all.success_rate->high);
}

TEST(Narrowing, IsTheIntervalOfTheFirstTrialsAtEachOfAboutAHundredNumbers) {
  const Finished made = finished(drawn_spec(3000));
  const Narrowing narrowed = narrowing(made);
  EXPECT_GE(narrowed.trials.size(), 60U);
  EXPECT_LE(narrowed.trials.size(), 101U);
  EXPECT_EQ(narrowed.trials.front(), 1U);
  for (std::size_t k = 0; k < narrowed.trials.size(); ++k) {
    const auto n = static_cast<std::ptrdiff_t>(narrowed.trials[k]);
    const auto& outcomes = made.result.trials.outcomes;
    const auto converged = std::count_if(outcomes.begin(), outcomes.begin() + n,
                                         [](const TrialOutcome& o) { return o.status == Status::converged; });
    const ProportionInterval expected =
        wilson_interval(static_cast<std::uint64_t>(converged), narrowed.trials[k], 0.95);
    EXPECT_EQ(narrowed.low[k], expected.low);
    EXPECT_EQ(narrowed.high[k], expected.high);
    if (k > 0) {
      EXPECT_GT(narrowed.trials[k], narrowed.trials[k - 1]);
    }
  }
}

TEST(Narrowing, LooksNoFartherThanTheFirstTrialThatIsMissing) {
  Finished made = finished(drawn_spec(500));
  keep_trials(made, [](std::uint64_t index) { return index != 200; });
  EXPECT_EQ(narrowing(made).of, 200U);
  keep_trials(made, [](std::uint64_t index) { return index != 0; });
  EXPECT_EQ(narrowing(made).of, 0U);
  EXPECT_TRUE(narrowing(made).trials.empty());
}

TEST(Narrowing, LooksAtWholeDrawsOfASweptStudy) {
  const Finished made =
      finished(drawn_spec(100, R"(, "controller": {"contraction": {"eta1": {"sweep": [0.4, 0.5, 0.6]}}})"));
  const Narrowing narrowed = narrowing(made);
  EXPECT_EQ(narrowed.of, 300U);
  for (const std::uint64_t trials : narrowed.trials) EXPECT_EQ(trials % 3, 0U);
  const Summary summary = summarise(made.study, made.result);
  EXPECT_EQ(narrowed.low.back(), summary.all.success_rate->low);
  EXPECT_EQ(narrowed.high.back(), summary.all.success_rate->high);
}

TEST(Narrowing, CountsTheIndependentTrialsOfAPickFreezeDesign) {
  const Finished made = finished(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}},
                                     "sampling": {"method": "sobol_indices", "trials": 100}})");
  EXPECT_EQ(made.result.trials.index.size(), 400U);
  EXPECT_EQ(narrowing(made).of, 200U);
}

}  // namespace
}  // namespace steerstat
