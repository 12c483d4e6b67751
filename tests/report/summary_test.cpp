#include "report/summary.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/version.hpp"
#include "statistics/clustered.hpp"
#include "statistics/confidence_sequence.hpp"
#include "study/plan.hpp"
#include "study/spec_json.hpp"
#include "study/watched.hpp"

namespace steerstat {
namespace {

Study sweep_of_two(std::uint64_t trials) {
  return decode_study(R"({"name": "two cells", "plant": {"m1": {"uniform": [0.8, 1.2]}},
                          "controller": {"contraction": {"eta1": {"sweep": [0.3, 0.5]}}},
                          "sampling": {"trials": )" +
                          std::to_string(trials) + R"(, "seed": 11}})",
                      {});
}

TrialOutcome ended(Status status, double end_time, std::uint32_t cycles) {
  TrialOutcome outcome;
  outcome.status = status;
  outcome.end_time = end_time;
  outcome.cycles = cycles;
  return outcome;
}

/// Six of the trials of sweep_of_two(4): cell 0 has the trials of even index.
StudyResult six_trials() {
  StudyResult result;
  result.trials.index = {0, 1, 2, 3, 4, 7};
  result.trials.outcomes = {ended(Status::converged, 40.0, 5), ended(Status::timeout, 300.0, 20),
                            ended(Status::converged, 50.0, 6), ended(Status::singular, 3.0, 0),
                            ended(Status::diverged, 9.0, 1),   ended(Status::converged, 90.0, 9)};
  result.wall_s = 2.0;
  result.threads = 2;
  return result;
}

/// The successes of its four draws, which are what is independent.
const std::vector<ClusterSum> four_draws{{2, 1.0}, {2, 1.0}, {1, 0.0}, {1, 1.0}};

TEST(Summarise, SaysWhichStudyItIsOf) {
  const Study study = sweep_of_two(4);
  const Summary summary = summarise(study, six_trials());
  EXPECT_EQ(summary.id, study_id(study));
  EXPECT_EQ(summary.name, "two cells");
  EXPECT_EQ(summary.spec_sha256, spec_sha256(study));
  EXPECT_EQ(summary.engine_version, engine_version());
  EXPECT_EQ(summary.seed, 11U);
  EXPECT_FALSE(summary.complete);
  EXPECT_EQ(summary.requested, 8U);
  EXPECT_EQ(summary.wall_s, 2.0);
  EXPECT_EQ(summary.threads, 2U);
}

TEST(Summarise, CountsEveryFinishedTrialInTheDenominator) {
  const TrialStatistics all = summarise(sweep_of_two(4), six_trials()).all;
  EXPECT_EQ(all.completed, 6U);
  EXPECT_EQ(all.outcomes, (std::array<std::uint64_t, 5>{3, 1, 1, 1, 0}));
  ASSERT_TRUE(all.success_rate);
  EXPECT_EQ(all.success_rate->estimate, 0.5);
  const ProportionInterval of_draws = clustered_proportion(ProportionMethod::wilson, four_draws, 0.95);
  EXPECT_EQ(all.success_rate->low, of_draws.low);
  EXPECT_EQ(all.success_rate->high, of_draws.high);
  EXPECT_LT(of_draws.low, wilson_interval(3, 6, 0.95).low);
  EXPECT_EQ(all.success_rate->level, 0.95);
}

TEST(Summarise, TakesTheIntervalThatTheSpecAsksFor) {
  Study study = sweep_of_two(4);
  study.intervals = {ProportionMethod::clopper_pearson, 0.9};
  const Summary summary = summarise(study, six_trials());
  const ProportionInterval of_draws = clustered_proportion(ProportionMethod::clopper_pearson, four_draws, 0.9);
  EXPECT_EQ(summary.all.success_rate->low, of_draws.low);
  EXPECT_EQ(summary.all.success_rate->high, of_draws.high);
  EXPECT_EQ(summary.cells[0].statistics.success_rate->low, clopper_pearson_interval(2, 3, 0.9).low);
}

TEST(Summarise, FollowsTheRuleOfAStudyThatStops) {
  Study study = sweep_of_two(4);
  EXPECT_FALSE(summarise(study, six_trials()).stop);
  study.stop = StopRule{2, 1, 0.95, {{"success_rate", std::nullopt, 0.49, false}}};
  study.intervals = default_intervals(true);
  const Summary summary = summarise(study, six_trials());
  ASSERT_TRUE(summary.stop);
  EXPECT_EQ(summary.stop->rule, *study.stop);
  EXPECT_EQ(summary.stop->report.trials, watched(study, six_trials().trials)->trials);
  EXPECT_EQ(summary.all.success_rate->low, confidence_sequence(2, 4, 0.95).low);
}

TEST(Summarise, DescribesTheConvergedTrialsAlone) {
  const TrialStatistics all = summarise(sweep_of_two(4), six_trials()).all;
  EXPECT_EQ(all.of("settling_time"), describe(std::vector<double>{40.0, 50.0, 90.0}));
  EXPECT_EQ(all.of("cycles"), describe(std::vector<double>{5.0, 6.0, 9.0}));
}

TEST(Summarise, GivesEachCellItsOwnTrials) {
  const Summary summary = summarise(sweep_of_two(4), six_trials());
  ASSERT_EQ(summary.cells.size(), 2U);
  ASSERT_EQ(summary.cells[1].sweep.size(), 1U);
  EXPECT_EQ(summary.cells[1].sweep[0].name, "controller.contraction.eta1");
  EXPECT_EQ(summary.cells[0].sweep[0].value, 0.3);
  EXPECT_EQ(summary.cells[1].sweep[0].value, 0.5);
  EXPECT_EQ(summary.cells[0].statistics.outcomes, (std::array<std::uint64_t, 5>{2, 0, 0, 1, 0}));
  EXPECT_EQ(summary.cells[1].statistics.outcomes, (std::array<std::uint64_t, 5>{1, 1, 1, 0, 0}));
  EXPECT_EQ(summary.cells[0].statistics.of("settling_time"), describe(std::vector<double>{40.0, 50.0}));
  EXPECT_EQ(summary.cells[1].statistics.of("settling_time"), describe(std::vector<double>{90.0}));
}

TEST(Summarise, HasNoStatisticsWithoutTrials) {
  const Summary summary = summarise(sweep_of_two(4), StudyResult{});
  EXPECT_EQ(summary.all.completed, 0U);
  EXPECT_FALSE(summary.all.success_rate);
  EXPECT_FALSE(summary.all.of("settling_time"));
  EXPECT_FALSE(summary.all.of("cycles"));
  ASSERT_EQ(summary.cells.size(), 2U);
  EXPECT_FALSE(summary.cells[0].statistics.success_rate);
}

TEST(Summarise, HasASuccessRateButNoSettlingTimeWhereNoTrialConverged) {
  StudyResult result;
  result.trials.index = {0};
  result.trials.outcomes = {ended(Status::timeout, 300.0, 3)};
  result.complete = true;
  const Summary summary = summarise(decode_study("{}", {}), result);
  ASSERT_TRUE(summary.all.success_rate);
  EXPECT_EQ(summary.all.success_rate->estimate, 0.0);
  EXPECT_FALSE(summary.all.of("settling_time"));
  EXPECT_TRUE(summary.cells.empty());
  EXPECT_TRUE(summary.complete);
}

AuditedTrial audit_of(std::uint64_t index, Status status, double settling_time, std::uint32_t cycles) {
  return audited(index, ended(status, settling_time, cycles));
}

TEST(Summarise, ComparesTheAuditedTrialsWithTheirOwnRows) {
  StudyResult result = six_trials();
  result.audit.tolerance = 1e-11;
  result.audit.trials = {audit_of(0, Status::converged, 40.5, 5), audit_of(1, Status::timeout, 300.0, 20),
                         audit_of(2, Status::converged, 50.0, 7),  // one cycle more
                         audit_of(4, Status::timeout, 300.0, 1),   // another end
                         audit_of(7, Status::converged, 89.75, 9)};
  const auto audit = summarise(sweep_of_two(4), result).audit;
  ASSERT_TRUE(audit);
  EXPECT_EQ(audit->trials, 5U);
  EXPECT_EQ(audit->agree, 3U);
  EXPECT_EQ(audit->disagree, (std::vector<std::uint64_t>{2, 4}));
  ASSERT_TRUE(audit->settling_time_difference);
  EXPECT_EQ(audit->settling_time_difference->median, 0.375);
  EXPECT_EQ(audit->settling_time_difference->p99, quantile(std::vector<double>{0.25, 0.5}, 0.99));
  EXPECT_EQ(audit->settling_time_difference->max, 0.5);
  EXPECT_EQ(audit->tolerance, 1e-11);
}

TEST(Summarise, HasNoSettlingTimeDifferenceWhereNoConvergedTrialAgrees) {
  StudyResult result = six_trials();
  result.audit.trials = {audit_of(1, Status::timeout, 300.0, 20), audit_of(2, Status::converged, 50.0, 7)};
  const auto audit = summarise(sweep_of_two(4), result).audit;
  ASSERT_TRUE(audit);
  EXPECT_FALSE(audit->settling_time_difference);
}

TEST(Summarise, HasNoAuditWithoutAuditedTrials) {
  EXPECT_FALSE(summarise(sweep_of_two(4), six_trials()).audit);
}

TEST(Summarise, CellsAddUpToTheWhole) {
  StudyResult result;
  for (std::uint64_t index = 0; index < 200; ++index) {
    result.trials.index.push_back(index);
    result.trials.outcomes.push_back(ended(static_cast<Status>(index * 7 % 5), static_cast<double>(index), 1));
  }
  const Summary summary = summarise(sweep_of_two(100), result);
  for (std::size_t status = 0; status < status_names.size(); ++status) {
    EXPECT_EQ(summary.cells[0].statistics.outcomes[status] + summary.cells[1].statistics.outcomes[status],
              summary.all.outcomes[status]);
  }
  EXPECT_EQ(summary.cells[0].statistics.completed, 100U);
}

}  // namespace
}  // namespace steerstat
