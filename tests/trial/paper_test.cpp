#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "every_method.hpp"
#include "trial/replay.hpp"

/// CONTROLLER.md section 7: the paper's two runs, and the trial whose alignments dip.
namespace steerstat::testing {
namespace {

constexpr double time_error = 0.02;   // [s]
constexpr double state_error = 1e-4;  // rad, rad/s

/// A phase as the rows of a replay tell it.
struct PhaseRecord {
  PhaseKind kind;
  double start;
  double end;
  State<double> end_state;
};

/// Splits a trajectory at the times that appear twice.
std::vector<PhaseRecord> phases_of(const Trajectory& trajectory) {
  std::vector<PhaseRecord> phases;
  double start = 0.0;
  const auto& rows = trajectory.samples;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i == 0 || rows[i].t == rows[i - 1].t) start = rows[i].t;
    if (i + 1 == rows.size() || rows[i].t == rows[i + 1].t)
      phases.push_back({rows[i].phase, start, rows[i].t, rows[i].state});
  }
  return phases;
}

/// What section 7 tabulates.
struct PaperFigures {
  double alignment_end;           // T1
  double speed_at_alignment_end;  // q2_dot there
  double transition_end;
  double angle_at_transition_end;
  long contractions;
  double contractions_duration;
};

PaperFigures figures_of(const Trajectory& trajectory) {
  const std::vector<PhaseRecord> phases = phases_of(trajectory);
  EXPECT_EQ(phases.at(0).kind, PhaseKind::align);
  EXPECT_EQ(phases.at(1).kind, PhaseKind::drift);
  EXPECT_EQ(phases.at(2).kind, PhaseKind::contraction);
  const PhaseRecord& alignment = phases[0];
  const PhaseRecord& transition = phases[1];
  return {alignment.end,
          alignment.end_state.q2_dot,
          transition.end,
          transition.end_state.q2,
          std::ranges::count(phases, PhaseKind::contraction, &PhaseRecord::kind),
          phases.back().end - transition.end};
}

class Paper : public EveryMethod {};

TEST_P(Paper, TheNominalRunIsReproduced) {
  TrialParameters nominal;
  nominal.controller.realignment = Realignment::never;
  nominal.controller.alignment.tolerance = 3.33e-4;
  const Trajectory trajectory = replay(nominal, integrator());
  const PaperFigures figures = figures_of(trajectory);
  EXPECT_NEAR(figures.alignment_end, 3.40, time_error);
  EXPECT_NEAR(figures.speed_at_alignment_end, 0.0659, state_error);
  EXPECT_NEAR(figures.transition_end, 14.90, time_error);
  EXPECT_NEAR(figures.angle_at_transition_end, 0.3927, state_error);
  EXPECT_EQ(figures.contractions, 9);
  EXPECT_NEAR(figures.contractions_duration, 32.37, time_error);

  const TrialOutcome& outcome = trajectory.outcome;
  EXPECT_EQ(outcome.status, Status::converged);
  EXPECT_EQ(outcome.cycles, 9u);
  EXPECT_EQ(outcome.swings, 0u);
  EXPECT_EQ(outcome.alignments, 1u);
  EXPECT_NEAR(outcome.end_time, 47.270, time_error);
  EXPECT_NEAR(outcome.end_state.q2, 0.78115, state_error);
  EXPECT_NEAR(outcome.end_state.q2_dot, 5.66e-4, state_error);
}

TEST_P(Paper, TheRunWithFrictionIsReproduced) {
  TrialParameters friction;
  friction.plant.f1 = 0.02;
  friction.plant.f2 = 0.02;
  const Trajectory trajectory = replay(friction, integrator());
  const PaperFigures figures = figures_of(trajectory);
  EXPECT_NEAR(figures.transition_end, 18.27, time_error);
  EXPECT_NEAR(figures.angle_at_transition_end, 0.3927, state_error);
  EXPECT_EQ(figures.contractions, 7);
  EXPECT_NEAR(figures.contractions_duration, 48.43, time_error);

  const TrialOutcome& outcome = trajectory.outcome;
  EXPECT_EQ(outcome.status, Status::converged);
  EXPECT_EQ(outcome.cycles, 7u);
  EXPECT_EQ(outcome.swings, 0u);
  EXPECT_EQ(outcome.alignments, 8u);  // the first, and one after each cycle
  EXPECT_NEAR(outcome.end_time, 66.700, time_error);
  EXPECT_NEAR(outcome.end_state.q2, 0.78217, state_error);
  EXPECT_NEAR(outcome.end_state.q2_dot, 7.39e-4, state_error);
}

TEST_P(Paper, AlignmentsThatDipThroughTheToleranceEndThere) {
  TrialParameters trial;
  trial.start = {0.0603608156672828, -0.21585049184725724, -0.0986681884420404, 0.06331720478758573};
  trial.plant.m1 = 1.1022245230829437;
  trial.plant.m2 = 0.9207837842362312;
  trial.plant.f1 = 0.014927178814451658;
  trial.plant.f2 = 0.0032548929628400283;
  const TrialOutcome outcome = run(trial);
  EXPECT_EQ(outcome.status, Status::converged);
  EXPECT_NEAR(outcome.end_time, 27.2236, 5e-5);
  EXPECT_EQ(outcome.cycles, 7u);
  EXPECT_EQ(outcome.alignments, 7u);
}

TEST_P(Paper, FrictionOnThePassiveJointAloneHasACliff) {
  TrialParameters trial;
  for (const double f2 : {0.005, 0.010, 0.015, 0.018}) {
    trial.plant.f2 = f2;
    EXPECT_EQ(run(trial).status, Status::converged) << f2;
  }
  for (const double f2 : {0.026, 0.03, 0.04, 0.05}) {
    trial.plant.f2 = f2;
    EXPECT_EQ(run(trial).status, Status::timeout) << f2;
  }
}

INSTANTIATE_TEST_SUITE_P(, Paper, every_method(), method_name);

}  // namespace
}  // namespace steerstat::testing
