#include "supervision_fixture.hpp"

/// What begins and ends a trial, and when the first joint is realigned: rules 1-3 of CONTROLLER.md section 5, at their
/// boundaries, on both sides.
namespace steerstat::testing {
namespace {

// --- the start ---

TEST(Supervisor, EveryTrialStartsWithAnAlignUnlessAligned) {
  Supervision s;
  s.controller.alignment.tolerance = 0x1p-10;
  const Decision align = s.first({above(0x1p-10), -0.6, 0.0, 0.0});
  expect_runs(align, PhaseKind::align);
  EXPECT_EQ(align.phase.active_tolerance, 0x1p-10);
  EXPECT_EQ(align.phase.duration, infinity);
  EXPECT_EQ(align.memory.alignments, 1u);
  EXPECT_EQ(align.memory.decisions, 0u);

  const Decision skipped = s.first({0x1p-10, -0.6, 0.0, 0.0});
  expect_runs(skipped, PhaseKind::swing);
  EXPECT_EQ(skipped.memory.alignments, 0u);
}

TEST(Supervisor, AnAlignThatHasNoTimeLeftIsNotCounted) {
  Supervision s;
  s.controller.horizon = 1e-12;
  const Decision late = s.first({1.0, -0.6, 0.0, 0.0});
  expect_stops(late, Status::timeout);
  EXPECT_EQ(late.memory.alignments, 0u);
  s.controller.horizon = above(1e-12);
  expect_runs(s.first({1.0, -0.6, 0.0, 0.0}), PhaseKind::align);
}

TEST(Supervisor, AFarStartIsAlignedFirstAndANonFiniteOneHasDiverged) {
  const Supervision s;
  expect_runs(s.first({2e3, -0.6, 0.0, 0.0}), PhaseKind::align);
  expect_stops(s.first({not_a_number, -0.6, 0.0, 0.0}), Status::diverged);
  expect_stops(s.first({1.0, -0.6, 0.0, infinity}), Status::diverged);
}

// --- what ends a trial ---

TEST(Supervisor, AStateBeyondAThousandHasDiverged) {
  Supervision s;
  s.goal = goal_at(5.0, pi / 4);
  expect_stops(s.after(PhaseKind::align, {5.0 + above(1e3), 1.0, 0.0, 0.0}), Status::diverged);
  expect_stops(s.after(PhaseKind::align, {5.0 - above(1e3), 1.0, 0.0, 0.0}), Status::diverged);
  expect_runs(s.after(PhaseKind::align, {5.0 + 1e3, 1.0, 0.0, 0.0}), PhaseKind::swing);
  expect_runs(s.after(PhaseKind::align, {5.0 - 1e3, 1.0, 0.0, 0.0}), PhaseKind::swing);
  expect_stops(s.after(PhaseKind::align, {5.0, 1.0, 0.0, above(1e3)}), Status::diverged);
  expect_stops(s.after(PhaseKind::align, {5.0, 1.0, 0.0, -above(1e3)}), Status::diverged);
  expect_runs(s.after(PhaseKind::align, {5.0, 1.0, 0.0, 1e3}), PhaseKind::drift);
  expect_runs(s.after(PhaseKind::align, {5.0, 1.0, 0.0, -1e3}), PhaseKind::drift);
}

TEST(Supervisor, ANonFiniteStateHasDivergedWhateverElseHolds) {
  const Supervision s;
  for (const double bad : {not_a_number, infinity, -infinity}) {
    for (const State<double>& x : {State<double>{bad, 0.7, 0.0, 0.0}, State<double>{0.0, bad, 0.0, 0.0},
                                   State<double>{0.0, 0.7, bad, 0.0}, State<double>{0.0, 0.7, 0.0, bad}}) {
      expect_stops(s.after(PhaseKind::align, x), Status::diverged);
      expect_stops(s.after(PhaseKind::contraction, x, s.controller.horizon), Status::diverged);
    }
  }
}

TEST(Supervisor, TheHorizonComesWithinAPicosecond) {
  Supervision s;
  s.controller.horizon = 1.0;
  expect_stops(s.after(PhaseKind::align, swinging_state, 1.0 - 1e-12), Status::timeout);
  expect_runs(s.after(PhaseKind::align, swinging_state, below(1.0 - 1e-12)), PhaseKind::swing);
}

TEST(Supervisor, TheHorizonGoesBeforeRealignmentAndConvergence) {
  const Supervision s;
  expect_stops(s.after(PhaseKind::contraction, {0.01, pi / 4, 0.0, 0.0}, 300.0), Status::timeout);
  expect_stops(s.after(PhaseKind::align, {0.0, pi / 4, 0.0, 0.0}, 300.0), Status::timeout);
}

TEST(Supervisor, TenThousandDecisionsAreEnough) {
  const Supervision s;
  Memory memory{PhaseKind::align};
  memory.decisions = 9999;
  const Decision last = decide(1.0, swinging_state, memory, s.controller, s.goal);
  expect_runs(last, PhaseKind::swing);
  EXPECT_EQ(last.memory.decisions, 10000u);
  expect_stops(decide(2.0, swinging_state, last.memory, s.controller, s.goal), Status::timeout);
}

TEST(Supervisor, ConvergesAtThePassiveToleranceAndNotAbove) {
  const Supervision s;
  for (const double turns : {0.0, 1.0, -3.0}) {
    const double q2 = pi / 4 + turns * 2.0 * pi;
    expect_stops(s.after(PhaseKind::align, {0.0, q2, 0.0, 0.004999}), Status::converged);
    expect_stops(s.after(PhaseKind::align, {0.0, q2 - 0.002, 0.0, -0.002999}), Status::converged);
    EXPECT_FALSE(s.after(PhaseKind::align, {0.0, q2 - 0.002, 0.0, -0.003001}).outcome.has_value());
  }
  expect_stops(s.after(PhaseKind::align, {0.0, pi / 4, 0.0, 0.005}), Status::converged);
  EXPECT_FALSE(s.after(PhaseKind::align, {0.0, pi / 4, 0.0, above(0.005)}).outcome.has_value());
}

TEST(Supervisor, AlignsAndDecidesAgainWhereOnlyThePassiveJointHasConverged) {
  Supervision s;
  s.controller.convergence.active_tolerance = 0x1p-6;
  expect_stops(s.after(PhaseKind::align, {0x1p-6, pi / 4, 0.0, 0.0}), Status::converged);
  const Decision align = s.after(PhaseKind::align, {above(0x1p-6), pi / 4, 0.0, 0.0});
  expect_runs(align, PhaseKind::align);
  EXPECT_EQ(align.memory.alignments, 1u);
  EXPECT_EQ(align.memory.decisions, 1u);
}

TEST(Supervisor, LinkTwoAtRestStretchedOrFoldedIsSingular) {
  const Supervision s;
  for (const double axis : {0.0, pi, -pi, 2.0 * pi}) {
    expect_stops(s.after(PhaseKind::align, {0.0, axis, 0.0, 0.0}), Status::singular);
    expect_stops(s.after(PhaseKind::align, {0.0, axis + 0.99e-6, 0.0, 1e-6}), Status::singular);
    expect_stops(s.after(PhaseKind::align, {0.0, axis - 0.99e-6, 0.0, -1e-6}), Status::singular);
    expect_runs(s.after(PhaseKind::align, {0.0, axis + 1.01e-6, 0.0, 0.0}), PhaseKind::swing);
    expect_runs(s.after(PhaseKind::align, {0.0, axis, 0.0, above(1e-6)}), PhaseKind::swing);
    expect_runs(s.after(PhaseKind::align, {0.0, axis, 0.0, -above(1e-6)}), PhaseKind::swing);
  }
}

// --- realignment ---

TEST(Supervisor, RealignsAfterThePhasesThatItsModeNames) {
  Supervision s;
  const State<double> x{0.01, -0.6, 0.0, 0.0};
  const auto realigns = [&](PhaseKind last) { return s.after(last, x).phase.kind == PhaseKind::align; };
  for (const Realignment mode : {Realignment::never, Realignment::after_cycle, Realignment::always}) {
    s.controller.realignment = mode;
    EXPECT_EQ(realigns(PhaseKind::contraction), mode != Realignment::never);
    EXPECT_EQ(realigns(PhaseKind::swing), mode != Realignment::never);
    EXPECT_EQ(realigns(PhaseKind::drift), mode == Realignment::always);
    EXPECT_FALSE(realigns(PhaseKind::align));
  }
}

TEST(Supervisor, RealignsBeforeItJudgesConvergenceAndWithoutADecision) {
  Supervision s;
  const State<double> x{0.01, pi / 4, 0.0, 0.0};  // within both tolerances of convergence
  const Decision align = s.after(PhaseKind::contraction, x);
  expect_runs(align, PhaseKind::align);
  EXPECT_EQ(align.memory.decisions, 0u);
  s.controller.realignment = Realignment::never;
  expect_stops(s.after(PhaseKind::contraction, x), Status::converged);
}

TEST(Supervisor, SkipsARealignmentThatIsNotNeeded) {
  Supervision s;
  s.controller.alignment.tolerance = 0x1p-10;
  const Decision skipped = s.after(PhaseKind::swing, {0.0, -0.6, -0x1p-10, 0.0});
  expect_runs(skipped, PhaseKind::swing);
  EXPECT_EQ(skipped.memory.alignments, 0u);
  expect_runs(s.after(PhaseKind::swing, {0.0, -0.6, -above(0x1p-10), 0.0}), PhaseKind::align);
}

}  // namespace
}  // namespace steerstat::testing
