#include "supervision_fixture.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

/// What holds of every decision of the supervisor.
namespace steerstat::testing {
namespace {

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
}  // namespace steerstat::testing
