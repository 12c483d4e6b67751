#include "study/subset_simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <stop_token>
#include <string>

#include "study/spec_json.hpp"

namespace steerstat {
namespace {

// The paper's cliff: trials fail where friction on the passive joint exceeds about 0.0247.
Study rising(const std::string& trials = "200") {
  return decode_study(R"({"plant": {"f2": {"triangular": [0, 0, 0.0252]}}, "metrics": false, "audit": {"trials": 2},
                          "retain": {"trajectories": {"failed": 1}},
                          "sampling": {"method": "subset_simulation", "seed": 4, "trials": )" +
                          trials + "}}",
                      {});
}

RunOptions on(unsigned threads) {
  RunOptions options;
  options.threads = threads;
  return options;
}

TEST(RunSubsetSimulation, IsTheSameBitsOnOneAndThreeThreads) {
  const SubsetRun one = run_subset_simulation(rising(), on(1));
  const SubsetRun three = run_subset_simulation(rising(), on(3));
  EXPECT_EQ(one.study, three.study);
  EXPECT_EQ(one.result.trials.outcomes, three.result.trials.outcomes);
  EXPECT_EQ(one.result.audit.trials.size(), 2U);
  EXPECT_TRUE(one.result.complete);
}

TEST(RunSubsetSimulation, BeginsWithThePlainTrialsOfItsSeed) {
  const SubsetRun run = run_subset_simulation(rising(), on(2));
  Study plain = rising();
  plain.sampling.method = SamplingMethod::monte_carlo;
  const StudyResult expected = run_study(plain, on(2));
  ASSERT_GT(run.result.trials.outcomes.size(), 200U);
  for (std::size_t row = 0; row < 200; ++row) {
    ASSERT_EQ(run.result.trials.outcomes[row], expected.trials.outcomes[row]) << row;
  }
}

TEST(RunSubsetSimulation, LeavesAStudyWhosePlanHasItsTrials) {
  const SubsetRun run = run_subset_simulation(rising(), on(2));
  const Plan plan(run.study);
  ASSERT_EQ(plan.trials(), run.result.trials.outcomes.size());
  ASSERT_EQ(run.result.trajectories.size(), 1U);  // replayed to the bit, or run_study() had thrown
  const std::uint64_t failed = run.result.trajectories[0].index;
  EXPECT_NE(make_runner(run.study.integrator)->run(plan.parameters(failed)).status, Status::converged);
}

TEST(RunSubsetSimulation, EstimatesWhatPlainTrialsCount) {
  const SubsetRun run = run_subset_simulation(rising("2000"), on(2));
  const SubsetEstimate found = subset_estimate(subset_levels(run.study, run.result.trials), 0.95);
  EXPECT_TRUE(found.trusted) << found.reason;
  Study plain = rising();
  plain.sampling.method = SamplingMethod::monte_carlo;
  plain.sampling.trials = 20'000;
  plain.audited_trials = 0;
  plain.retention = {};
  std::uint64_t failures = 0;
  for (const TrialOutcome& outcome : run_study(plain, on(2)).trials.outcomes) {
    failures += outcome.status != Status::converged ? 1U : 0U;
  }
  ASSERT_GT(failures, 0U);
  const double p = static_cast<double>(failures) / 20'000.0;
  EXPECT_LT(p, 0.01);
  const double error = std::hypot(found.estimate * found.variation, std::sqrt(p / 20'000.0));
  EXPECT_NEAR(found.estimate, p, 4.0 * error);
}

TEST(RunSubsetSimulation, KeepsNothingWhereAStopIsRequested) {
  std::stop_source stop;
  stop.request_stop();
  RunOptions options = on(1);
  options.stop = stop.get_token();
  const SubsetRun run = run_subset_simulation(rising(), options);
  EXPECT_FALSE(run.result.complete);
  EXPECT_TRUE(run.result.trials.index.empty());
}

TEST(SubsetLevelsOfAStudy, RefuseTrialsThatAreNotOfSuchARun) {
  SubsetRun run = run_subset_simulation(rising(), on(2));
  run.result.trials.outcomes.pop_back();
  EXPECT_THROW(subset_levels(run.study, run.result.trials), std::invalid_argument);
}

TEST(Performance, IsTheTimeToConvergeAndBeyondAnyWhereThereIsNone) {
  TrialOutcome outcome;
  outcome.status = Status::converged;
  outcome.end_time = 300.0;
  EXPECT_EQ(performance(outcome), 300.0);
  outcome.status = Status::timeout;
  EXPECT_TRUE(std::isinf(performance(outcome)));
}

}  // namespace
}  // namespace steerstat
