#include "trial/runner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <vector>

#include "combined_study.hpp"
#include "every_method.hpp"
#include "trial/replay.hpp"

namespace steerstat::testing {
namespace {

TrialParameters starting_at(const State<double>& start) {
  TrialParameters trial;
  trial.start = start;
  return trial;
}

class Runner : public EveryMethod {};

// --- each status ---

TEST_P(Runner, AStartAtTheGoalHasConvergedAtOnce) {
  const TrialOutcome outcome = run(starting_at({0.0, std::numbers::pi / 4, 0.0, 0.0}));
  EXPECT_EQ(outcome.status, Status::converged);
  EXPECT_EQ(outcome.end_time, 0.0);
  EXPECT_EQ(outcome.settling_time(), 0.0);
  EXPECT_EQ(outcome.alignments, 0u);
}

TEST_P(Runner, AStretchedOrFoldedLinkAtRestIsSingularAfterTheAlign) {
  for (const double axis : {0.0, std::numbers::pi, -std::numbers::pi}) {
    const TrialOutcome outcome = run(starting_at({0.5, axis, 0.0, 0.0}));
    EXPECT_EQ(outcome.status, Status::singular) << axis;
    EXPECT_EQ(outcome.alignments, 1u);
    EXPECT_NEAR(outcome.end_state.q2, axis, 1e-12);
    EXPECT_GT(outcome.end_time, 1.0);
    EXPECT_TRUE(std::isnan(outcome.settling_time()));
  }
  EXPECT_EQ(run(starting_at({0.0, std::numbers::pi, 0.0, 0.0})).end_time, 0.0)
      << "an align that is not needed takes no time";
}

TEST_P(Runner, ATrialWithTooMuchFrictionTimesOutAtTheHorizon) {
  TrialParameters trial;
  trial.plant.f2 = 0.04;
  const TrialOutcome outcome = run(trial);
  EXPECT_EQ(outcome.status, Status::timeout);
  EXPECT_EQ(outcome.end_time, 300.0);
  EXPECT_TRUE(std::isnan(outcome.settling_time()));
}

TEST_P(Runner, ARunawayStateHasDivergedEvenAtTheHorizon) {
  TrialParameters far = starting_at({5000.0, 0.3, 0.0, 0.0});
  far.controller.horizon = 0.1;
  const TrialOutcome cut = run(far);
  EXPECT_EQ(cut.status, Status::diverged);
  EXPECT_EQ(cut.end_time, 0.1);
  const TrialOutcome spinning = run(starting_at({0.5, 0.3, 0.0, 1100.0}));
  EXPECT_EQ(spinning.status, Status::diverged);
  EXPECT_EQ(spinning.alignments, 1u) << "every trial starts with an align";
}

TEST_P(Runner, APlantTooStiffForTheStepsFailsTheIntegrator) {
  TrialParameters trial = starting_at({1.0, 0.7, 1.0, 0.0});
  trial.plant.f1 = 1e14;
  const TrialOutcome outcome = run(trial);
  EXPECT_EQ(outcome.status, Status::integrator_failed);
  EXPECT_LT(outcome.end_time, 1.0);
}

TEST_P(Runner, NumbersThatAreNotFiniteEndTheTrialInOrder) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    TrialParameters plant;
    plant.plant.m1 = bad;
    EXPECT_NE(run(plant).status, Status::converged);
    EXPECT_EQ(run(starting_at({bad, 0.3, 0.0, 0.0})).status, Status::diverged);
    EXPECT_EQ(run(starting_at({0.0, 0.3, 0.0, bad})).status, Status::diverged);
  }
}

// --- the horizon ---

TEST_P(Runner, TheHorizonCutsAPhaseThatWasCounted) {
  struct Cut {
    double horizon;
    std::uint32_t alignments;
    std::uint32_t cycles;
  };
  // The paper's nominal run aligns to 3.4 s, drifts to 14.9 s, then contracts.
  for (const Cut& cut : {Cut{1.0, 1, 0}, Cut{10.0, 1, 0}, Cut{16.0, 1, 1}}) {
    TrialParameters trial;
    trial.controller.realignment = Realignment::never;
    trial.controller.alignment.tolerance = 3.33e-4;
    const Trajectory whole = replay(trial, integrator(), 0.25);
    trial.controller.horizon = cut.horizon;
    const TrialOutcome outcome = run(trial);
    EXPECT_EQ(outcome.status, Status::timeout);
    EXPECT_EQ(outcome.end_time, cut.horizon);
    EXPECT_EQ(outcome.alignments, cut.alignments);
    EXPECT_EQ(outcome.cycles, cut.cycles);
    for (const TrajectorySample& sample : whole.samples) {
      if (sample.t != cut.horizon) continue;
      EXPECT_NEAR(sample.state.q1, outcome.end_state.q1, 1e-8) << "cut short, the phase is the same";
      EXPECT_NEAR(sample.state.q2, outcome.end_state.q2, 1e-8);
      EXPECT_NEAR(sample.state.q2_dot, outcome.end_state.q2_dot, 1e-8);
    }
  }
}

TEST_P(Runner, AnAlignWithNoTimeLeftIsNotCounted) {
  TrialParameters trial;
  trial.controller.horizon = 1e-13;
  const TrialOutcome outcome = run(trial);
  EXPECT_EQ(outcome.status, Status::timeout);
  EXPECT_EQ(outcome.alignments, 0u);
}

// --- what an outcome reports, and streams ---

TEST_P(Runner, ReportsTheErrorsOfTheEndState) {
  for (const TrialParameters& trial : combined_study(20)) {
    const TrialOutcome outcome = run(trial);
    EXPECT_EQ(outcome.passive_error, passive_error(outcome.end_state, trial.goal));
    EXPECT_EQ(outcome.active_error, active_error(outcome.end_state, trial.goal));
    if (outcome.status == Status::converged) {
      EXPECT_LE(outcome.passive_error, 0.005);
      EXPECT_LE(outcome.active_error, 0.02);
    }
  }
}

/// Hands out trials in a given order, and keeps what comes back.
class ListedTrials final : public TrialStream {
 public:
  ListedTrials(const std::vector<TrialParameters>& study, std::vector<std::uint64_t> order)
      : outcomes(study.size()), study_(study), order_(std::move(order)) {}

  bool next(std::uint64_t& index, TrialParameters& parameters) override {
    if (taken_ == order_.size()) return false;
    index = order_[taken_++];
    parameters = study_[index];
    return true;
  }

  void finished(std::uint64_t index, const TrialOutcome& outcome) override {
    EXPECT_TRUE(done.insert(index).second) << index << " finished twice";
    outcomes[index] = outcome;
  }

  std::vector<TrialOutcome> outcomes;
  std::set<std::uint64_t> done;

 private:
  const std::vector<TrialParameters>& study_;
  std::vector<std::uint64_t> order_;
  std::size_t taken_{0};
};

TEST_P(Runner, ATrialsBitsAreTheSameAloneAndInAnyStream) {
  std::vector<TrialParameters> study = combined_study(60);
  study[7].plant.f1 = 1e14;                // fails
  study[20].start = {0.5, 0.0, 0.0, 0.0};  // singular
  study[33].start.q2_dot = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::uint64_t> forwards;
  for (std::uint64_t i = 0; i < study.size(); ++i) forwards.push_back(i);
  const std::vector<std::uint64_t> backwards(forwards.rbegin(), forwards.rend());

  const auto runner = make_runner(integrator());
  ListedTrials first(study, forwards);
  ListedTrials second(study, backwards);
  runner->run(first);
  runner->run(second);
  EXPECT_EQ(first.done.size(), study.size());
  for (std::size_t i = 0; i < study.size(); ++i) {
    EXPECT_TRUE(same_bits(first.outcomes[i], second.outcomes[i])) << i;
    EXPECT_TRUE(same_bits(first.outcomes[i], run(study[i]))) << i;
  }
}

TEST_P(Runner, AnEmptyStreamIsRunDryAtOnce) {
  const std::vector<TrialParameters> study;
  ListedTrials none(study, {});
  make_runner(integrator())->run(none);
  EXPECT_TRUE(none.done.empty());
}

INSTANTIATE_TEST_SUITE_P(, Runner, every_method(), method_name);

}  // namespace
}  // namespace steerstat::testing
