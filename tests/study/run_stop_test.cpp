// Runs that end before their last trial: on the precision of what they have found, or given up.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "study/plan.hpp"
#include "study/run.hpp"
#include "study/spec_json.hpp"
#include "study/watched.hpp"

namespace steerstat {
namespace {

/// A study that looks every 50 draws; `until` are its goals. Blocks are of 16 trials.
Study stopping_study(const std::string& until, const std::string& more = "") {
  return decode_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "initial_state": {"q1": {"uniform": [-1, 1]}},
                          "integrator": {"method": "cvode"}, "audit": {"trials": 0}, "sampling": {"trials": 4000},
                          "stop": {"check_every": 50, "until": [)" +
                          until + "]}" + more + "}",
                      {});
}

const char* const rate_within_5_percent = R"({"metric": "success_rate", "half_width": 0.05})";

/// Cheap stand-in for an engine: four in five draws converge, at a time that they tell.
class DrawRunner final : public TrialRunner {
 public:
  /// Called before a trial ends.
  using OnTrial = std::function<void(std::uint64_t index, TrialStream& stream)>;

  explicit DrawRunner(OnTrial on_trial) : on_trial_(std::move(on_trial)) {}

  static TrialOutcome outcome_of(const TrialParameters& parameters) {
    TrialOutcome outcome;
    outcome.status = parameters.start.q1 > -0.6 ? Status::converged : Status::timeout;
    outcome.end_time = 100.0 * parameters.plant.m1;
    return outcome;
  }

  using TrialRunner::run;
  void run(TrialStream& stream) override {
    std::uint64_t index = 0;
    TrialParameters parameters;
    while (stream.next(index, parameters)) {
      if (on_trial_) on_trial_(index, stream);
      stream.finished(index, outcome_of(parameters));
    }
  }

 private:
  OnTrial on_trial_;
};

RunOptions drawn(unsigned threads, const DrawRunner::OnTrial& on_trial = {}) {
  RunOptions options;
  options.threads = threads;
  options.make_runner = [on_trial](const IntegratorChoice&) { return std::make_unique<DrawRunner>(on_trial); };
  return options;
}

/// Delays a trial now and then, so that blocks finish out of order.
void dawdle(std::uint64_t index, TrialStream&) {
  if ((index * 2654435761U) % 97 < 3) std::this_thread::sleep_for(std::chrono::microseconds(300));
}

/// Where the study stops when its trials are looked at one after the other.
StopReport expected_stop(const Study& study) {
  const Plan plan(study);
  PrecisionWatch watch(*study.stop, study.sampling.trials, plan.cells());
  for (std::uint64_t i = 0; i < plan.trials(); ++i) watch.add(DrawRunner::outcome_of(plan.parameters(i)));
  return watch.report();
}

void expect_exactly(std::uint64_t trials, const StudyResult& result, const Study& study) {
  const Plan plan(study);
  EXPECT_TRUE(result.complete);
  ASSERT_EQ(result.trials.index.size(), trials);
  ASSERT_EQ(result.trials.outcomes.size(), trials);
  for (std::uint64_t i = 0; i < trials; ++i) {
    EXPECT_EQ(result.trials.index[i], i);
    EXPECT_TRUE(same_bits(result.trials.outcomes[i], DrawRunner::outcome_of(plan.parameters(i)))) << "trial " << i;
  }
}

TEST(RunStudyThatStops, KeepsTheTrialsUpToTheLookWhateverTheThreadsAndTheirTiming) {
  const Study study = stopping_study(rate_within_5_percent);
  const StopReport expected = expected_stop(study);
  ASSERT_EQ(expected.reason, StopReason::precision_reached);
  ASSERT_EQ(expected.trials % 50, 0U);
  for (const unsigned threads : {1U, 2U, 3U}) {
    expect_exactly(expected.trials, run_study(study, drawn(threads)), study);
    expect_exactly(expected.trials, run_study(study, drawn(threads, dawdle)), study);
  }
}

TEST(RunStudyThatStops, LooksAfterSoManyDrawsOfEveryCell) {
  const Study study = stopping_study(
      std::string(rate_within_5_percent) + R"(, {"metric": "settling_time", "quantile": 0.5, "half_width": 3})",
      R"(, "controller": {"entry_fraction": {"sweep": [0.4, 0.5, 0.6]}})");
  const StopReport expected = expected_stop(study);
  ASSERT_EQ(expected.reason, StopReason::precision_reached);
  ASSERT_EQ(expected.trials % 150, 0U);
  for (const unsigned threads : {1U, 3U}) expect_exactly(expected.trials, run_study(study, drawn(threads)), study);
}

TEST(RunStudyThatStops, RunsToItsLastTrialWhereThePrecisionIsNotReached) {
  const Study study = stopping_study(R"({"metric": "success_rate", "half_width": 0.001})");
  const StudyResult result = run_study(study, drawn(2));
  expect_exactly(4000, result, study);
  EXPECT_EQ(watched(study, result.trials)->reason, StopReason::max_trials);
}

TEST(RunStudyThatStops, BeginsNoBlockOnceItKnows) {
  const Study study = stopping_study(rate_within_5_percent);
  std::uint64_t begun = 0;
  RunOptions options = drawn(1);
  options.on_progress = [&](const Progress& progress) { begun = progress.completed; };
  const StudyResult result = run_study(study, options);
  EXPECT_GE(begun, result.trials.index.size());
  EXPECT_LT(begun, result.trials.index.size() + 2 * block_size(study));
}

TEST(RunStudyThatStops, IsIncompleteWhereItWasInterruptedFirst) {
  const Study study = stopping_study(rate_within_5_percent);
  std::stop_source stop;
  RunOptions options = drawn(2);
  options.stop = stop.get_token();
  stop.request_stop();
  const StudyResult result = run_study(study, options);
  EXPECT_FALSE(result.complete);
  EXPECT_TRUE(result.trials.index.empty());
  EXPECT_FALSE(watched(study, result.trials)->reason);
  EXPECT_EQ(trials_due(study, result.trials), 4000U);
}

TEST(RunStudyThatStops, IsCompleteWhereTheInterruptionCameAfterTheLastLookThatMattered) {
  const Study study = stopping_study(R"({"metric": "success_rate", "half_width": 0.49})");
  const std::uint64_t expected = expected_stop(study).trials;
  ASSERT_EQ(expected, 50U);
  std::stop_source stop;
  RunOptions options = drawn(1, [&](std::uint64_t index, TrialStream&) {
    if (index == 49) stop.request_stop();  // in the block that ends the look
  });
  options.stop = stop.get_token();
  expect_exactly(expected, run_study(study, options), study);
}

TEST(RunStudyThatStops, AuditsAndRetainsTrialsThatItKeeps) {
  const Study study = decode_study(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}}, "horizon": 5,
      "sampling": {"trials": 2000}, "audit": {"trials": 3}, "retain": {"trajectories": {"failed": 1, "first": 2}},
      "stop": {"check_every": 30, "until": [{"metric": "success_rate", "half_width": 0.06}]}})",
                                   {});
  const StudyResult one = run_study(study, {.threads = 1});
  const StudyResult three = run_study(study, {.threads = 3});
  EXPECT_TRUE(one.complete);
  EXPECT_LT(one.trials.index.size(), 200U);
  EXPECT_EQ(one.trials.index, three.trials.index);
  EXPECT_EQ(one.trials.outcomes, three.trials.outcomes);
  ASSERT_EQ(one.audit.trials.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT(one.audit.trials[i].index, one.trials.index.size());
    EXPECT_EQ(one.audit.trials[i].index, three.audit.trials[i].index);
  }
  EXPECT_EQ(one.trajectories.size(), 2U);
}

TEST(RunStudyGivenUp, LeavesTheTrialsInFlightAndHandsOverWhatHadFinished) {
  const Study study = stopping_study(rate_within_5_percent, R"(, "horizon": 50)");
  constexpr std::uint64_t endless = 70;
  std::stop_source give_up;
  struct Kept final : OutcomeSink {
    void take(std::uint64_t begin, std::span<const TrialOutcome> outcomes) override {
      EXPECT_EQ(begin, trials);
      trials += outcomes.size();
    }
    std::uint64_t trials{0};
  } kept;
  RunOptions options = drawn(1, [&](std::uint64_t index, TrialStream& stream) {
    if (index == endless) give_up.request_stop();
    while (index == endless) stream.check_in();
  });
  options.give_up = give_up.get_token();
  options.sink = &kept;
  EXPECT_THROW(run_study(study, options), RunGivenUp);
  EXPECT_EQ(kept.trials, endless / block_size(study) * block_size(study));
}

/// Starts so fast that a trial takes a minute or more.
Study endless_study(const std::string& method) {
  return decode_study(R"({"initial_state": {"q2_dot": 1e8}, "integrator": {"method": ")" + method +
                          R"("}, "sampling": {"trials": 20}})",
                      {});
}

TEST(RunStudyGivenUp, EndsAtOnceWhateverItIsAt) {
  std::stop_source give_up;
  give_up.request_stop();
  for (const std::string method : {"lockstep", "cvode"}) {
    const Study study = endless_study(method);
    const auto check_in = [] { throw RunGivenUp(); };
    EXPECT_THROW(run_study(study, {.threads = 2, .give_up = give_up.get_token()}), RunGivenUp) << method;
    EXPECT_THROW(replay(Plan(study).parameters(0), study.integrator, 0.05, 0, check_in), RunGivenUp);
    EXPECT_THROW(make_runner(study.integrator)->run(Plan(study).parameters(0), check_in), RunGivenUp);
  }
}

TEST(Watched, SaysNothingWithoutARuleAndStopsAtTheFirstGap) {
  const Study study = stopping_study(rate_within_5_percent);
  Study ruleless = study;
  ruleless.stop.reset();
  TrialTable trials;
  for (const std::uint64_t index : {0U, 1U, 2U, 4U}) {
    trials.index.push_back(index);
    trials.outcomes.push_back(DrawRunner::outcome_of(Plan(study).parameters(index)));
  }
  EXPECT_FALSE(watched(ruleless, trials));
  EXPECT_EQ(watched(study, trials)->trials, 3U);
  EXPECT_EQ(trials_due(ruleless, trials), 4000U);
}

}  // namespace
}  // namespace steerstat
