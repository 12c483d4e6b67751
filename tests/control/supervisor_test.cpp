#include "control/supervisor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "control/cycle.hpp"

/// Each rule of CONTROLLER.md section 5, at its boundaries, on both sides.
namespace steerstat {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

double above(double x) {
  return std::nextafter(x, infinity);
}
double below(double x) {
  return std::nextafter(x, -infinity);
}

/// A controller, the paper's goal, and what the supervisor decides with them.
struct Supervision {
  Controller controller{};
  Goal goal{goal_at(0.0, pi / 4)};

  /// At the end of a phase of the kind `last`.
  Decision after(PhaseKind last, const State<double>& x, double t = 1.0) const {
    return decide(t, x, Memory{last}, controller, goal);
  }

  /// At the trial's start.
  Decision first(const State<double>& x) const { return decide(0.0, x, Memory{}, controller, goal); }

  /// The phase that rules 4-7 choose for an aligned robot.
  Phase steer(double q2, double q2_dot) const {
    const Decision decision = after(PhaseKind::align, {0.0, q2, 0.0, q2_dot});
    EXPECT_FALSE(decision.outcome.has_value()) << q2 << ' ' << q2_dot;
    return decision.phase;
  }
};

void expect_stops(const Decision& decision, Status status) {
  ASSERT_TRUE(decision.outcome.has_value()) << "runs " << name_of(decision.phase.kind);
  EXPECT_EQ(*decision.outcome, status) << name_of(*decision.outcome);
}

void expect_runs(const Decision& decision, PhaseKind kind) {
  ASSERT_FALSE(decision.outcome.has_value()) << "stops, " << name_of(*decision.outcome);
  EXPECT_EQ(decision.phase.kind, kind) << name_of(decision.phase.kind);
}

constexpr State<double> swinging_state{0.0, -0.6, 0.0, 0.0};  // at rest, off the axes: rule 7

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

// --- rule 4, contraction ---

TEST(Supervisor, ContractsFromTheEntryPointToTheGoal) {
  const Supervision s;
  const double w = s.goal.width;
  EXPECT_EQ(s.steer(0.5 * w - 1e-6, 0.1).kind, PhaseKind::contraction);
  EXPECT_EQ(s.steer(below(0.5 * w - 1e-6), 0.1).kind, PhaseKind::drift);
  EXPECT_EQ(s.steer(below(w), 0.1).kind, PhaseKind::contraction);
  EXPECT_EQ(s.steer(w, 0.1).kind, PhaseKind::drift);
}

TEST(Supervisor, ContractsOnlyTowardsTheGoal) {
  Supervision s;
  s.controller.contraction.max_period = 1e12;
  EXPECT_EQ(s.steer(0.6, 1e-10).kind, PhaseKind::contraction);
  EXPECT_EQ(s.steer(0.6, 0.0).kind, PhaseKind::swing);
  EXPECT_EQ(s.steer(0.6, -1e-10).kind, PhaseKind::swing);
}

TEST(Supervisor, ACycleLongerThanTheLongestIsASwingInstead) {
  Supervision s;
  const Phase phase = s.steer(0.6, 0.05);
  ASSERT_EQ(phase.kind, PhaseKind::contraction);
  s.controller.contraction.max_period = phase.duration;
  EXPECT_EQ(s.steer(0.6, 0.05).kind, PhaseKind::contraction);
  s.controller.contraction.max_period = below(phase.duration);
  EXPECT_EQ(s.steer(0.6, 0.05).kind, PhaseKind::swing) << "a slow joint inside the set must not drift past the goal";
}

TEST(Supervisor, TheCycleHasThePeriodAndAmplitudeOf16And17) {
  Supervision s;
  s.controller.contraction = {0.3, 0.7, 30.0};
  const double q2 = 0.5;
  const double omega = 0.08;
  const Phase phase = s.steer(q2, omega);
  const double period = 0.7 * (pi / 4 - q2) / omega;
  EXPECT_NEAR(phase.duration, period, 1e-14 * period);
  const double amplitude = std::sqrt(period * 0.3 * omega / (0.16 * beta * std::sin(2.0 * q2)));
  EXPECT_NEAR(phase.amplitude, amplitude, 1e-14 * amplitude);
}

// --- rule 5, drift towards the goal ---

TEST(Supervisor, DriftsTowardsTheGoalFasterThanRestAlone) {
  const Supervision s;
  EXPECT_EQ(s.steer(1.2, above(1e-3)).kind, PhaseKind::drift);
  EXPECT_EQ(s.steer(1.2, 1e-3).kind, PhaseKind::swing);
}

TEST(Supervisor, TheDriftEndsAtTheEntryPointOrAtRest) {
  const Supervision s;
  const double entry = pi / 8;
  for (const double q2 : {-2.0, -0.3, 0.0, 0.1}) {
    const Phase phase = s.steer(q2, 0.1);
    ASSERT_EQ(phase.kind, PhaseKind::drift);
    EXPECT_NEAR(phase.q2_high, entry, 4e-15) << q2;
    EXPECT_EQ(phase.q2_low, -infinity);
    EXPECT_EQ(phase.direction, 1.0);
    EXPECT_EQ(phase.speed_floor, 0.99e-3);
    EXPECT_EQ(phase.duration, infinity);
    EXPECT_LT(phase.active_tolerance, 0.0);
  }
  EXPECT_NEAR(s.steer(1.0, 0.1).q2_high, entry + 2.0 * pi, 4e-15);  // past the goal: once round
  EXPECT_NEAR(s.steer(pi / 8 - 1.1e-6, 0.1).q2_high, entry, 4e-15);
  EXPECT_NEAR(s.steer(1.0 - 6.0 * pi, 0.1).q2_high, entry - 4.0 * pi, 1e-13);
}

TEST(Supervisor, ASlowDriftIsSpedUpWhereASwingCan) {
  Supervision s;
  s.controller.drift.min_speed = 0.05;
  const double edge = -0.5 * std::asin(0.4);  // s2 = -0.4
  EXPECT_EQ(s.steer(edge - 1e-9, below(0.05)).kind, PhaseKind::swing);
  EXPECT_EQ(s.steer(edge + 1e-9, below(0.05)).kind, PhaseKind::drift);
  EXPECT_EQ(s.steer(edge - 1e-9, 0.05).kind, PhaseKind::drift);
}

// --- rule 6, drift away from the goal ---

TEST(Supervisor, DriftsAwayFromTheGoalFasterThanRestAlone) {
  const Supervision s;
  EXPECT_EQ(s.steer(0.6, -above(1e-3)).kind, PhaseKind::drift);
  EXPECT_EQ(s.steer(0.6, -1e-3).kind, PhaseKind::swing);
}

TEST(Supervisor, DriftsAwayOnlyWhereASwingHasNoAuthority) {
  const Supervision s;
  const double edge = -0.5 * std::asin(0.4);  // s2 = -0.4
  EXPECT_EQ(s.steer(edge + 1e-9, -0.1).kind, PhaseKind::drift);
  EXPECT_EQ(s.steer(edge - 1e-9, -0.1).kind, PhaseKind::swing);
}

TEST(Supervisor, TheDriftAwayEndsWhereASwingHasAuthorityOrAtRest) {
  Supervision s;
  for (const double authority : {0.1, 0.4, 0.89}) {
    s.controller.swing.min_authority = authority;
    for (const double turns : {0.0, 0.5, 1.0, -3.5}) {
      for (const double offset : {-0.02, 0.0, 0.3, pi / 2, pi / 2 + 0.02}) {
        const double q2 = offset + turns * 2.0 * pi;
        const Phase phase = s.steer(q2, -0.1);
        ASSERT_EQ(phase.kind, PhaseKind::drift);
        EXPECT_NEAR(std::sin(2.0 * phase.q2_low), -(authority + 0.1), 1e-13);
        EXPECT_NEAR(std::sin(2.0 * phase.q2_high), -(authority + 0.1), 1e-13);
        EXPECT_LT(phase.q2_low, q2);
        EXPECT_GT(phase.q2_high, q2);
        EXPECT_LT(phase.q2_high - phase.q2_low, pi);  // the nearest such angles on both sides
        EXPECT_EQ(phase.direction, -1.0);
        EXPECT_EQ(phase.speed_floor, 0.99e-3);
      }
    }
  }
}

// --- rule 7, swing ---

double swing_amplitude(double change, double s2) {
  return std::sqrt(2.0 * change / (0.16 * beta * s2));
}

Supervision without_amplitude_bound() {
  Supervision s;
  s.controller.swing.max_amplitude = 1e9;
  return s;
}

TEST(Supervisor, ASwingBringsTheSpeedToTheWantedOneWhereItPushesTowardsTheGoal) {
  const Supervision s = without_amplitude_bound();
  for (const double omega : {0.0, 5e-4, -5e-4, -0.1}) {
    const Phase phase = s.steer(-0.6, omega);
    ASSERT_EQ(phase.kind, PhaseKind::swing);
    EXPECT_EQ(phase.duration, 2.0);
    const double amplitude = swing_amplitude(0.2 - omega, std::sin(1.2));
    EXPECT_NEAR(phase.amplitude, amplitude, 1e-13 * amplitude) << omega;
  }
}

TEST(Supervisor, ASwingBringsTheSpeedToTheOppositeOneWhereItPushesAway) {
  const Supervision s = without_amplitude_bound();
  for (const double omega : {0.0, 5e-4, -5e-4}) {
    const double amplitude = swing_amplitude(0.2 + omega, std::sin(1.2));
    EXPECT_NEAR(s.steer(0.6, omega).amplitude, amplitude, 1e-13 * amplitude) << omega;
  }
}

TEST(Supervisor, ASwingOfAJointFasterThanWantedUsesTheWantedSpeed) {
  Supervision s = without_amplitude_bound();
  s.controller.drift.min_speed = 1.0;  // so that a fast joint does not drift
  EXPECT_EQ(s.steer(-0.6, 0.2).amplitude, 0.0);
  EXPECT_LT(s.steer(-0.6, below(0.2)).amplitude, 1e-4);
  const double amplitude = swing_amplitude(0.2, std::sin(1.2));
  EXPECT_NEAR(s.steer(-0.6, above(0.2)).amplitude, amplitude, 1e-13 * amplitude);
}

TEST(Supervisor, TheSwingsAmplitudeIsBoundedByTheLargestAndByTheLeastSine) {
  Supervision s;
  EXPECT_EQ(s.steer(1e-5, 5e-4).amplitude, 200.0);
  s.controller.swing.max_amplitude = 1e9;
  const double at_least_sine = swing_amplitude(0.2 + 5e-4, 1e-6);
  EXPECT_NEAR(s.steer(0.49e-6, 5e-4).amplitude, at_least_sine, 1e-13 * at_least_sine);
  EXPECT_LT(s.steer(0.51e-6, 5e-4).amplitude, at_least_sine);
}

// --- counts, symmetry, purity ---

TEST(Supervisor, CountsEachPhaseOnceUnderItsOwnName) {
  const Supervision s;
  const auto counts = [&](const Decision& d) {
    return std::vector<std::uint32_t>{d.memory.decisions, d.memory.cycles, d.memory.swings, d.memory.alignments};
  };
  using Counts = std::vector<std::uint32_t>;
  const auto aligned = [&](double q2, double q2_dot) { return s.after(PhaseKind::align, {0.0, q2, 0.0, q2_dot}); };
  EXPECT_EQ(counts(aligned(0.6, 0.1)), (Counts{1, 1, 0, 0}));
  EXPECT_EQ(counts(aligned(-0.6, 0.0)), (Counts{1, 0, 1, 0}));
  EXPECT_EQ(counts(aligned(-0.6, 0.1)), (Counts{1, 0, 0, 0}));
  EXPECT_EQ(counts(s.after(PhaseKind::swing, {0.5, -0.6, 0.0, 0.1})), (Counts{0, 0, 0, 1}));
  EXPECT_EQ(aligned(0.6, 0.1).memory.last, PhaseKind::contraction);
  EXPECT_EQ(aligned(-0.6, 0.1).memory.last, PhaseKind::drift);
}

std::vector<State<double>> random_aligned_states(int count) {
  std::mt19937_64 generator(20);
  std::uniform_real_distribution<double> angle(-7.0, 7.0);
  std::uniform_real_distribution<double> exponent(-5.0, 1.0);
  std::vector<State<double>> states;
  for (int i = 0; i < count; ++i) {
    const double speed = std::pow(10.0, exponent(generator));
    states.push_back({0.0, angle(generator), 0.0, i % 2 == 0 ? speed : -speed});
  }
  return states;
}

void expect_same_bound(double bound, double image) {
  ASSERT_EQ(std::isfinite(bound), std::isfinite(image));
  if (std::isfinite(bound)) {
    EXPECT_NEAR(bound, image, 1e-13);
  }
}

void expect_mirrored(const Phase& phase, const Phase& image, double sign, double shift) {
  ASSERT_EQ(phase.kind, image.kind);
  if (phase.kind == PhaseKind::drift) {
    expect_same_bound((sign > 0.0 ? phase.q2_low : -phase.q2_high) + shift, image.q2_low);
    expect_same_bound((sign > 0.0 ? phase.q2_high : -phase.q2_low) + shift, image.q2_high);
    EXPECT_EQ(sign * phase.direction, image.direction);
    EXPECT_EQ(phase.speed_floor, image.speed_floor);
  } else {
    // The cycle's numbers inherit the rounding of q2 + shift, relative to how near the goal or an axis is.
    EXPECT_NEAR(phase.duration, image.duration, 1e-10 * phase.duration);
    EXPECT_NEAR(phase.amplitude, image.amplitude, 1e-10 * phase.amplitude);
  }
}

TEST(Supervisor, TheOtherQuadrantsAreTheFirstOneMirroredOrTurned) {
  const Supervision first;
  struct Image {
    double sign;
    double shift;
  };
  int kinds[4] = {};
  for (const auto& [sign, shift] : {Image{-1.0, 0.0}, Image{1.0, pi}, Image{-1.0, pi}, Image{-1.0, -2.0 * pi}}) {
    Supervision other;
    other.goal = goal_at(0.0, sign * pi / 4 + shift);
    EXPECT_EQ(other.goal.sigma, sign);
    for (const State<double>& x : random_aligned_states(2000)) {
      if (passive_error(x, first.goal) <= 0.01) continue;  // converged
      const Phase phase = first.steer(x.q2, x.q2_dot);
      expect_mirrored(phase, other.steer(sign * x.q2 + shift, sign * x.q2_dot), sign, shift);
      ++kinds[static_cast<std::size_t>(phase.kind)];
    }
  }
  EXPECT_GT(kinds[static_cast<std::size_t>(PhaseKind::drift)], 100);
  EXPECT_GT(kinds[static_cast<std::size_t>(PhaseKind::contraction)], 100);
  EXPECT_GT(kinds[static_cast<std::size_t>(PhaseKind::swing)], 100);
}

TEST(Supervisor, AnswersEveryStateTheSameWayTwiceWithAPhaseThatCanRun) {
  const Supervision s;
  const std::vector<double> values{0.0, -0.0, 5e-324, 1e-300, 1e-9, -1e-3, 0.7, pi, -999.0, 1e3, 1e18, 1e300};
  for (const double q2 : values) {
    for (const double q2_dot : values) {
      for (const double q1 : values) {
        const State<double> x{q1, q2, 0.0, q2_dot};
        const Memory memory{PhaseKind::align, 7, 1, 2, 3};
        const Decision once = decide(1.0, x, memory, s.controller, s.goal);
        const Decision twice = decide(1.0, x, memory, s.controller, s.goal);
        EXPECT_EQ(once.outcome, twice.outcome);
        EXPECT_EQ(once.phase, twice.phase);
        EXPECT_EQ(once.memory, twice.memory);
        if (once.outcome) continue;
        EXPECT_GT(once.phase.duration, 0.0);
        EXPECT_TRUE(std::isfinite(once.phase.amplitude) && once.phase.amplitude >= 0.0) << q2 << ' ' << q2_dot;
        EXPECT_FALSE(std::isnan(once.phase.q2_low) || std::isnan(once.phase.q2_high));
      }
    }
  }
}

}  // namespace
}  // namespace steerstat
