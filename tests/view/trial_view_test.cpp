#include "view/trial_view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "json_text.hpp"
#include "study/inputs.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

using Json = nlohmann::json;

/// The paper's run with friction: seven contraction cycles, each realigned.
const Study& friction() {
  static const Study study = decode_study(R"({"name": "friction", "plant": {"f1": 0.02, "f2": 0.02}})", {});
  return study;
}

struct Shown {
  Trajectory trajectory;
  TrialView view;
};

Shown shown(const Study& study, std::size_t points = most_trajectory_points) {
  const TrialParameters parameters = Plan(study).parameters(0);
  Shown result{replay_for_view(parameters, study.integrator), {}};
  result.view = trial_view(study, 0, parameters, result.trajectory, points);
  return result;
}

TEST(TrialView, KeepsTheEndsOfEveryPhaseToTheBit) {
  for (const std::size_t points : {most_trajectory_points, std::size_t{200}}) {
    const auto [trajectory, view] = shown(friction(), points);
    EXPECT_LE(view.samples.size(), points);
    ASSERT_EQ(view.phases.size(), trajectory.phases.size());
    ASSERT_EQ(view.phases_of, trajectory.phases.size());
    for (std::size_t i = 0; i < view.phases.size(); ++i) {
      const PhaseSpan& phase = trajectory.phases[i];
      EXPECT_EQ(view.samples[view.phases[i].first].state, trajectory.samples[phase.first].state);
      EXPECT_EQ(view.samples[view.phases[i].last].state, trajectory.samples[phase.last].state);
      EXPECT_EQ(view.samples[view.phases[i].first].t, trajectory.samples[phase.first].t);
      EXPECT_EQ(view.samples[view.phases[i].first].tau, trajectory.samples[phase.first].tau);
      EXPECT_EQ(view.phases[i].kind, phase.kind);
    }
    EXPECT_EQ(view.samples.back().t, trajectory.outcome.end_time);
  }
}

TEST(TrialView, LooksLikeTheWholeCourseIn600Points) {
  EXPECT_LT(shown(friction(), 600).view.largest_deviation, 0.01);
  EXPECT_LT(shown(friction()).view.largest_deviation, 0.002);
}

TEST(TrialView, ContractsAsTheOutcomeSays) {
  const auto [trajectory, view] = shown(friction());
  ASSERT_EQ(view.cycles.size(), trajectory.outcome.cycles);
  double position = 0.0;
  double velocity = 0.0;
  for (const ContractionCycle& cycle : view.cycles) {
    EXPECT_GT(cycle.distance_before, 0.0);
    position += cycle.distance_after / cycle.distance_before;
    velocity += cycle.speed_after / cycle.speed_before;
  }
  const auto n = static_cast<double>(view.cycles.size());
  EXPECT_NEAR(position / n, trajectory.outcome.position_contraction.mean, 1e-12);
  EXPECT_NEAR(velocity / n, trajectory.outcome.velocity_contraction.mean, 1e-12);
  EXPECT_LE(view.cycles.back().passive_error_after, 0.01);
}

TEST(TrialView, PredictsCyclesOfThePaperByTheirEtas) {
  for (const ContractionCycle& cycle : shown(friction()).view.cycles) {
    EXPECT_EQ(cycle.distance_predicted, 0.5 * cycle.distance_before);
    EXPECT_EQ(cycle.speed_predicted, 0.6 * cycle.speed_before);
  }
}

TEST(TrialView, PredictsCyclesOfTheRobustPolicyByWhatItAimsAtAfterTheirAlign) {
  const Study study = decode_study(R"({"plant": {"f1": 0.02, "f2": 0.02}, "controller": {"policy": "robust"}})", {});
  const auto [trajectory, view] = shown(study);
  ASSERT_EQ(view.cycles.size(), trajectory.outcome.cycles);
  ASSERT_GE(view.cycles.size(), 2U);
  bool aligned = false;
  for (const ContractionCycle& cycle : view.cycles) {
    // On a plant that is the nominal one but for friction, what the policy aims at is what happens, to a tenth or so.
    EXPECT_NEAR(cycle.speed_after, cycle.speed_predicted, 0.15 * cycle.speed_before);
    EXPECT_NEAR(cycle.distance_after, cycle.distance_predicted, 0.15 * cycle.distance_before);
    for (std::size_t i = 0; i + 1 < trajectory.phases.size(); ++i) {
      const PhaseSpan& next = trajectory.phases[i + 1];
      if (trajectory.samples[trajectory.phases[i].first].t != cycle.start || next.kind != PhaseKind::align) continue;
      EXPECT_EQ(trajectory.samples[next.last].t, cycle.end);
      EXPECT_NEAR(cycle.speed_predicted, 0.4 * cycle.distance_predicted, 1e-12);
      aligned = true;
    }
  }
  EXPECT_TRUE(aligned);
}

TEST(TrialView, LeavesOutTheCycleThatTheHorizonCut) {
  const Study study = decode_study(R"({"plant": {"f1": 0.02, "f2": 0.02}, "horizon": 20})", {});
  const auto [trajectory, view] = shown(study);
  ASSERT_EQ(trajectory.phases.back().kind, PhaseKind::contraction);
  EXPECT_FALSE(trajectory.phases.back().whole);
  EXPECT_EQ(view.cycles.size() + 1, trajectory.outcome.cycles);
}

TEST(TrialView, ListsTheFirstPhasesOfATrialOfVeryMany) {
  // A swing of next to nothing every twentieth of a second.
  const Study study = decode_study(R"({"controller": {"swing": {"period": 0.05, "max_amplitude": 0.001}},
                                       "initial_state": {"q1": 0, "q2": 1.0}, "horizon": 30})",
                                   {});
  const auto [trajectory, view] = shown(study);
  ASSERT_GT(trajectory.phases.size(), most_listed_phases);
  EXPECT_EQ(view.phases.size(), most_listed_phases);
  EXPECT_EQ(view.phases_of, trajectory.phases.size());
  EXPECT_LE(view.samples.size(), most_trajectory_points);
  EXPECT_EQ(view.samples.back().t, trajectory.outcome.end_time);
}

TEST(TrialView, ShowsATrialThatEndsWhereItStarts) {
  const Study study = decode_study(R"({"initial_state": {"q1": 0, "q2": 0.7853981633974483}})", {});
  const Json json = testing::json_of(trial_view_json(shown(study).view));
  EXPECT_EQ(json["outcome"]["status"], "converged");
  EXPECT_EQ(json["trajectory"]["t"].size(), json["trajectory"]["tau"].size());
  EXPECT_EQ(json["phases"]["of"], json["phases"]["kind"].size());
}

TEST(TrialViewJson, HasTheContractionSetAndTheGoalThatIsNearest) {
  const auto [trajectory, view] = shown(friction());
  const Json json = testing::json_of(trial_view_json(view));
  EXPECT_EQ(json["contraction_set"]["sigma"], 1);
  EXPECT_NEAR(json["contraction_set"]["q2_entry"], std::numbers::pi / 8, 1e-15);
  EXPECT_NEAR(json["contraction_set"]["least_rate"], 0.5 / 30.0, 1e-15);
  EXPECT_EQ(json["references"]["q2"], json["references"]["q2_nearest"]);
  EXPECT_EQ(json["contraction"]["eta1"], 0.5);
  for (const Json& start : json["contraction"]["start"]) {  // cycles begin inside the set
    const auto& t = json["trajectory"]["t"];
    const auto at = static_cast<std::size_t>(std::find(t.begin(), t.end(), start) - t.begin());
    ASSERT_LT(at, t.size());
    EXPECT_GE(json["trajectory"]["q2"][at].get<double>(), std::numbers::pi / 8 - 2e-6);
    EXPECT_LT(json["trajectory"]["q2"][at].get<double>(), std::numbers::pi / 4);
  }
}

TEST(TrialViewJson, HasTheSetWhereTheRobustPolicyBrakes) {
  const Study study = decode_study(R"({"controller": {"policy": "robust"}})", {});
  const auto [trajectory, view] = shown(study);
  const Json json = testing::json_of(trial_view_json(view));
  EXPECT_NEAR(json["contraction_set"]["q2_entry"], 0.3 * std::numbers::pi / 4, 1e-15);
  EXPECT_NEAR(json["contraction_set"]["least_rate"], 0.9 * 0.4, 1e-15);
  EXPECT_EQ(json["contraction"]["rate"], 0.4);
  EXPECT_EQ(json["contraction"]["eta1"], nullptr);
  for (const ContractionCycle& cycle : view.cycles) {  // cycles begin inside the set
    EXPECT_LE(cycle.distance_before, 0.7 * std::numbers::pi / 4 + 2e-6);
    EXPECT_GE(cycle.speed_before, 0.9 * 0.4 * cycle.distance_before - 1e-12);
  }
}

TEST(TrialViewJson, RoundsWhatIsDrawnAndNotWhatIsReported) {
  const auto [trajectory, view] = shown(friction());
  const Json json = testing::json_of(trial_view_json(view));
  EXPECT_EQ(json["outcome"]["end_time"].get<double>(), trajectory.outcome.end_time);
  for (std::size_t i = 0; i < view.samples.size(); ++i) {
    const double tau = view.samples[i].tau;
    EXPECT_NEAR(json["trajectory"]["tau"][i].get<double>(), tau, 5e-6 * std::abs(tau));
  }
  EXPECT_EQ(json["parameters"].size(), input_count);
}

TEST(ReplayForView, EndsInTheSameBitsAndSamplesShortCyclesToo) {
  const TrialParameters parameters = Plan(friction()).parameters(0);
  const Trajectory coarse = replay(parameters, friction().integrator);
  const Trajectory fine = replay_for_view(parameters, friction().integrator);
  EXPECT_EQ(coarse.outcome, fine.outcome);
  for (const PhaseSpan& phase : fine.phases) {
    if (phase.kind == PhaseKind::contraction || phase.kind == PhaseKind::swing) {
      EXPECT_GE(phase.last - phase.first, 31U);
    }
  }
}

}  // namespace
}  // namespace steerstat
