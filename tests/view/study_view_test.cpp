#include "view/study_view.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "../report/sample_comparison.hpp"
#include "json_text.hpp"

namespace steerstat {
namespace {

using Json = nlohmann::json;
using testing_report::drawn_spec;
using testing_report::finished;
using testing_report::Finished;
using testing_report::keep_trials;

std::uint64_t sum(const std::vector<std::uint64_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

StudyView view_of(const Finished& made, std::size_t maps = 0) {
  return study_view({made.study, made.result, made.parameters}, {{}, maps});
}

Summary summary_of(const Finished& made) {
  return summarise(made.study, made.result);
}

Json json_of(const Finished& made, std::size_t maps = 0) {
  return testing::json_of(study_view_json(view_of(made, maps), summary_of(made)));
}

const char* const swept = R"(, "controller": {"contraction": {"eta1": {"sweep": [0.6, 0.4]}}},
                             "initial_state": {"q2_dot": {"normal": {"mean": 0, "std": 0.1}}})";

TEST(StudyView, CountsAddUpToTheSummarys) {
  for (const std::string& spec :
       {drawn_spec(500), drawn_spec(300, swept), std::string(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}},
          "sampling": {"method": "sobol_indices", "trials": 100}})"),
        std::string(R"({"plant": {"m1": {"sweep": [1, 1.1]}, "f2": {"sweep": [0, 0.01, 0.02]}},
                        "sampling": {"method": "grid"}})")}) {
    const Finished made = finished(spec);
    const StudyView view = view_of(made, 10);
    const Summary summary = summary_of(made);
    const TrialStatistics& all = summary.all;
    const std::uint64_t converged = all.outcomes[0];
    EXPECT_EQ(view.used, all.completed);
    ASSERT_EQ(view.marginals.size(), view.inputs.size());
    for (const Marginal& marginal : view.marginals) {
      EXPECT_EQ(sum(marginal.counts.trials) + marginal.counts.outside, all.completed) << marginal.axis.input;
      if (marginal.counts.outside == 0) {
        EXPECT_EQ(sum(marginal.counts.successes), converged) << marginal.axis.input;
      }
    }
    EXPECT_EQ(sum(view.cycles.converged), converged);
    EXPECT_EQ(sum(view.cycles.converged) + sum(view.cycles.others), all.completed);
    EXPECT_EQ(view.failed.of, all.completed - converged);
    EXPECT_EQ(view.sample.of, all.completed);
    EXPECT_EQ(view.narrowing.of, all.completed);
    EXPECT_EQ(view.distributions.front().trials, converged);
    if (!view.sweeps.empty()) {
      std::uint64_t cells = 1;
      for (const StudyView::SweptAxis& axis : view.sweeps) cells *= axis.values.size();
      EXPECT_EQ(cells, summary.cells.size());
    }
  }
}

TEST(StudyView, ShowsEveryTrialOfTenThousandAndARandomChoiceOfMore) {
  const Finished few = finished(drawn_spec(10000));
  EXPECT_EQ(view_of(few).sample.index.size(), 10000U);
  EXPECT_TRUE(view_of(few, 5).maps.empty());

  const Finished many = finished(drawn_spec(10001));
  const StudyView view = view_of(many, 5);
  EXPECT_EQ(view.sample.of, 10001U);
  EXPECT_EQ(view.sample.index.size(), 10000U);
  ASSERT_EQ(view.maps.size(), 1U);  // two inputs make one pair
  EXPECT_EQ(sum(view.maps[0].counts.trials), 10001U);
  EXPECT_EQ(sum(view.maps[0].counts.successes), summary_of(many).all.outcomes[0]);
  EXPECT_TRUE(view_of(many).maps.empty());
}

TEST(StudyView, SamplesFairly) {
  const Finished many = finished(drawn_spec(40000));
  const StudyView::Sample sample = view_of(many).sample;
  ASSERT_EQ(sample.index.size(), 10000U);
  // Of each tenth of the trials a tenth, and as many successes as among all, within four standard errors.
  for (std::uint64_t tenth = 0; tenth < 10; ++tenth) {
    const auto of_it = std::count_if(sample.index.begin(), sample.index.end(),
                                     [&](std::uint64_t index) { return index / 4000 == tenth; });
    EXPECT_NEAR(static_cast<double>(of_it), 1000.0, 4.0 * std::sqrt(1000.0 * 0.9 * 0.75));
  }
  for (std::size_t i = 0; i < sample.index.size(); i += 97) {
    EXPECT_EQ(sample.status[i], many.result.trials.outcomes[sample.index[i]].status);
    EXPECT_EQ(sample.inputs[1][i], many.parameters[1][sample.index[i]]);
  }
}

TEST(StudyView, BandsOfAMarginalAreWilsonsOfItsBins) {
  const StudyView view = view_of(finished(drawn_spec(2000)));
  const Marginal& marginal = view.marginals[0];
  ASSERT_EQ(marginal.axis.bins(), 24U);
  for (std::size_t k = 0; k < 24; ++k) {
    const ProportionInterval expected = wilson_interval(marginal.counts.successes[k], marginal.counts.trials[k], 0.95);
    EXPECT_EQ(marginal.intervals[k]->low, expected.low);
    EXPECT_EQ(marginal.intervals[k]->high, expected.high);
  }
}

TEST(StudyView, BandsOfAMarginalCountDrawsAndNotTheirCells) {
  // Two cells whose trials end alike are no more evidence than one.
  const Finished one = finished(drawn_spec(400));
  Finished two = finished(drawn_spec(400, R"(, "controller": {"contraction": {"eta1": {"sweep": [0.4, 0.5]}}})"));
  for (std::size_t i = 0; i < 800; ++i) two.result.trials.outcomes[i] = one.result.trials.outcomes[i / 2];
  const StudyView of_one = view_of(one);
  const StudyView of_two = view_of(two);
  for (std::size_t k = 0; k < of_one.marginals[0].intervals.size(); ++k) {
    EXPECT_EQ(of_two.marginals[0].counts.trials[k], 2 * of_one.marginals[0].counts.trials[k]);
    const ProportionInterval& once = *of_one.marginals[0].intervals[k];
    const ProportionInterval& twice = *of_two.marginals[0].intervals[k];
    EXPECT_EQ(twice.estimate, once.estimate);
    EXPECT_GE(twice.high - twice.low, once.high - once.low - 1e-12);
    EXPECT_LE(twice.high - twice.low, 1.3 * (once.high - once.low));
  }
}

TEST(StudyView, HasTheIndicesOfTheFirstHundredThousandTrialsWhereThereAreMore) {
  for (const char* trials : {"100000", "100001"}) {
    const Finished made =
        finished(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "sampling": {"trials": )" + std::string(trials) + "}}");
    const StudyView view = view_of(made);
    EXPECT_EQ(view.sensitivity_of, 100000U);
    EXPECT_EQ(view.given_data.outputs[0].trials, 100000U);  // success, which every trial has
  }
}

TEST(StudyView, ListsTheFirstFailures) {
  const StudyView view = view_of(finished(drawn_spec(2000)));
  EXPECT_EQ(view.failed.index.size(), most_listed_failures);
  EXPECT_GT(view.failed.of, most_listed_failures);
  for (const Status status : view.failed.status) EXPECT_NE(status, Status::converged);
}

TEST(StudyView, ShowsAStudyWithoutFinishedTrials) {
  Finished nothing = finished(drawn_spec(10));
  keep_trials(nothing, [](std::uint64_t) { return false; });
  nothing.result.audit.trials.clear();
  const StudyView view = view_of(nothing, 10);
  EXPECT_TRUE(view.marginals.empty());
  EXPECT_TRUE(view.distributions.empty());
  const Json json = json_of(nothing, 10);
  EXPECT_EQ(json["trials"]["finished"], 0);
  EXPECT_EQ(json["inputs"][0]["low"], nullptr);
}

TEST(StudyView, OfTrialsThatSeekFailuresListsThemAndCountsNothing) {
  const Finished made = finished(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}},
    "sampling": {"method": "importance", "trials": 12000,
                 "proposal": {"nominal": 0.5, "components": [{"inputs": {"plant.f2": {"shift": 2}}}]}}})");
  const StudyView view = view_of(made, 5);
  EXPECT_EQ(view.rows, ShownRows::sought);
  const Summary summary = summary_of(made);
  EXPECT_TRUE(summary.rare_failures.has_value());
  EXPECT_EQ(view.sample.of, 12000U);
  EXPECT_EQ(view.sample.index.size(), 10000U);
  EXPECT_EQ(view.failed.of, 12000U - summary.all.outcomes[0]);
  EXPECT_EQ(view.narrowing.of, 0U);
  EXPECT_TRUE(view.distributions.empty() && view.cycles.from.empty() && view.marginals.empty() && view.maps.empty());
  EXPECT_EQ(json_of(made)["sensitivity"], nullptr);
}

TEST(StudyView, OfAStudyThatKeepsFailuresAloneCountsAllTrialsAndListsThose) {
  Finished made = finished(drawn_spec(400));
  TrialSketch sketch(1);
  sketch.add(0, made.result.trials.outcomes, [](std::size_t n, const auto& task) {
    for (std::size_t i = 0; i < n; ++i) task(i);
  });
  const std::uint64_t failures = 400 - summary_of(made).all.outcomes[0];
  keep_trials(made, [&, outcomes = made.result.trials.outcomes](std::uint64_t index) {
    return outcomes[index].status != Status::converged;
  });
  made.study.store = Store::failed;
  made.result.sketch = sketch;
  const StudyView view = view_of(made);
  EXPECT_EQ(view.rows, ShownRows::failed);
  EXPECT_EQ(view.used, 400U);
  EXPECT_EQ(summary_of(made).all.outcomes[0], 400U - failures);
  EXPECT_EQ(view.sample.of, failures);
  EXPECT_EQ(view.failed.of, failures);
  EXPECT_TRUE(view.marginals.empty());
}

TEST(StudyViewJson, HoldsTheCellsAsColumnsInTheOrderOfTheSummary) {
  const Finished made = finished(drawn_spec(50, swept));
  const Summary summary = summary_of(made);
  const Json json = json_of(made);
  EXPECT_TRUE(json["summary"]["cells"].empty());
  const Json& sweeps = json["sweeps"];
  EXPECT_EQ(sweeps["axes"][0]["values"], testing::json_of("[0.6, 0.4]"));
  ASSERT_EQ(sweeps["cells"]["trials"].size(), 2U);
  for (std::size_t cell = 0; cell < 2; ++cell) {
    EXPECT_EQ(summary.cells[cell].sweep[0].value, sweeps["axes"][0]["values"][cell].get<double>());
    EXPECT_EQ(sweeps["cells"]["successes"][cell], summary.cells[cell].statistics.outcomes[0]);
  }
  EXPECT_EQ(json_of(finished(drawn_spec(5)))["sweeps"], nullptr);
}

TEST(StudyViewJson, OfAHundredThousandTrialsAndEightInputsIsBelowTwoMegabytes) {
  const Finished made = finished(R"({
    "plant": {"m1": {"uniform": [0.8, 1.2]}, "m2": {"uniform": [0.8, 1.2]}, "f1": {"uniform": [0, 0.05]},
              "f2": {"uniform": [0, 0.05]}},
    "initial_state": {"q1": {"uniform": [-1, 1]}, "q2": {"uniform": [-3, 3]}, "q1_dot": {"uniform": [-0.5, 0.5]},
                      "q2_dot": {"uniform": [-0.5, 0.5]}},
    "sampling": {"trials": 12000}})");
  // Nothing in it grows with the trials beyond ten thousand but the digits of counts.
  const StudyView view = view_of(made, 45);
  EXPECT_EQ(view.maps.size(), 28U);
  EXPECT_LT(study_view_json(view, summary_of(made)).size(), 2'000'000U);
}

}  // namespace
}  // namespace steerstat
