#include "statistics/pick_freeze.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "known_sensitivities.hpp"

namespace steerstat {
namespace {

using namespace testing_statistics;

std::vector<double> design_of(const KnownSensitivities& known, std::size_t rows, std::uint64_t seed) {
  Draws draws(seed);
  std::vector<double> outputs;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::vector<double> a = draws.point(known.inputs());
    const std::vector<double> b = draws.point(known.inputs());
    outputs.push_back(known.function(a));
    outputs.push_back(known.function(b));
    for (std::size_t i = 0; i < known.inputs(); ++i) {
      std::vector<double> mixed = a;
      mixed[i] = b[i];
      outputs.push_back(known.function(mixed));
    }
  }
  return outputs;
}

void expect_indices_within_standard_errors(const KnownSensitivities& known, std::size_t rows) {
  const auto indices = pick_freeze_indices(design_of(known, rows, 3), known.inputs(), {0.9999, 5});
  ASSERT_TRUE(indices);
  ASSERT_EQ(indices->size(), known.inputs());
  for (std::size_t i = 0; i < known.inputs(); ++i) {
    const auto& [first_order, total] = (*indices)[i];
    // At the level 0.9999 the interval reaches 3.9 standard errors to either side.
    EXPECT_LE(first_order.low - 1e-12, known.first_order[i]) << i;
    EXPECT_GE(first_order.high + 1e-12, known.first_order[i]) << i;
    EXPECT_LE(total.low - 1e-12, known.total[i]) << i;
    EXPECT_GE(total.high + 1e-12, known.total[i]) << i;
    EXPECT_LT(first_order.high - first_order.low, 8.0 * 1.6 / std::sqrt(static_cast<double>(rows))) << i;
    EXPECT_LT(total.high - total.low, 8.0 * 1.6 / std::sqrt(static_cast<double>(rows))) << i;
  }
}

TEST(PickFreeze, MeetsTheClosedFormsOfTheIshigamiFunction) {
  expect_indices_within_standard_errors(ishigami(), 2000);
}

TEST(PickFreeze, MeetsTheClosedFormsOfTheGFunction) {
  expect_indices_within_standard_errors(g_function(), 2000);
}

TEST(PickFreeze, MeetsTheClosedFormsOfASuccessBehindTwoCliffs) {
  expect_indices_within_standard_errors(cliffs(), 2000);
}

TEST(PickFreeze, GroupsOfNeighboursGiveTheSameStandardErrorsAsRows) {
  const KnownSensitivities known = cliffs();
  const auto one_by_one = pick_freeze_indices(design_of(known, 16'384, 3), 3, {0.95, 5});
  const auto two_by_two = pick_freeze_indices(design_of(known, 32'768, 3), 3, {0.95, 5});
  for (std::size_t i = 0; i < 2; ++i) {
    const auto width = [&](const auto& indices) {
      return (*indices)[i].first_order.high - (*indices)[i].first_order.low;
    };
    // A standard error from 256 resamples is itself right to 1 / sqrt(512).
    EXPECT_NEAR(width(one_by_one) / width(two_by_two), std::sqrt(2.0), 4.0 * std::sqrt(2.0 / 512.0) * std::sqrt(2.0));
  }
}

TEST(PickFreeze, AnInputWithoutEffectHasIndicesOfExactlyZero) {
  const auto indices = pick_freeze_indices(design_of(ishigami(), 200, 1), 4, {});
  ASSERT_TRUE(indices);
  const auto& [first_order, total] = indices->back();
  EXPECT_NEAR(first_order.estimate, 0.0, 1e-12);
  EXPECT_NEAR(total.estimate, 0.0, 1e-12);
  EXPECT_NEAR(first_order.high - first_order.low, 0.0, 1e-11);
}

TEST(PickFreeze, AnOutputOfOneInputAloneIsItsOwnToTheRounding) {
  KnownSensitivities alone{[](std::span<const double> u) { return std::exp(u[1]); }, {0, 1}, {0, 1}};
  const auto indices = pick_freeze_indices(design_of(alone, 500, 1), 2, {});
  EXPECT_NEAR((*indices)[1].first_order.estimate, 1.0, 1e-12);
  EXPECT_NEAR((*indices)[0].first_order.estimate, 0.0, 1e-12);
  EXPECT_NEAR((*indices)[1].total.estimate, 1.0, 4.0 / std::sqrt(500.0));
}

TEST(PickFreeze, IntervalsCoverAtTheirLevelAndAreNoWiderThanTheyNeedBe) {
  const KnownSensitivities known = ishigami();
  constexpr std::size_t repeats = 200;
  std::vector<Simulation> first_order(known.inputs());
  std::vector<Simulation> total(known.inputs());
  for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
    const auto indices = pick_freeze_indices(design_of(known, 100, repeat), known.inputs(), {0.95, repeat});
    ASSERT_TRUE(indices);
    for (std::size_t i = 0; i < known.inputs(); ++i) {
      first_order[i].add((*indices)[i].first_order, known.first_order[i]);
      total[i].add((*indices)[i].total, known.total[i]);
    }
  }
  for (std::size_t i = 0; i < known.inputs(); ++i) {
    EXPECT_GE(first_order[i].coverage(), least_coverage(repeats)) << i;
    EXPECT_GE(total[i].coverage(), least_coverage(repeats)) << i;
    EXPECT_NEAR(first_order[i].mean(), known.first_order[i], 4.0 * first_order[i].standard_error_of_mean() + 0.02) << i;
    EXPECT_NEAR(total[i].mean(), known.total[i], 4.0 * total[i].standard_error_of_mean() + 0.02) << i;
    if (first_order[i].spread() > 1e-9) {
      EXPECT_NEAR(first_order[i].claimed() / first_order[i].spread(), 1.0, 0.2) << i;
      EXPECT_NEAR(total[i].claimed() / total[i].spread(), 1.0, 0.2) << i;
    }
  }
}

TEST(PickFreeze, FirstOrderIsAtLeastAsPreciseAsJanonsAndSaltellisEstimators) {
  const KnownSensitivities known = ishigami();
  constexpr std::size_t rows = 100;
  constexpr double n = rows;
  const std::size_t width = known.inputs() + 2;
  std::vector<Simulation> ours(known.inputs());
  std::vector<Simulation> janon(known.inputs());
  std::vector<Simulation> saltelli(known.inputs());
  for (std::uint64_t repeat = 0; repeat < 150; ++repeat) {
    const std::vector<double> outputs = design_of(known, rows, repeat);
    const auto indices = pick_freeze_indices(outputs, known.inputs(), {});
    for (std::size_t i = 0; i < known.inputs(); ++i) {
      double b = 0, c = 0, bb = 0, cc = 0, bc = 0, a = 0, aa = 0;
      for (std::size_t row = 0; row < rows; ++row) {
        const double fa = outputs[row * width];
        const double fb = outputs[row * width + 1];
        const double fc = outputs[row * width + 2 + i];
        a += fa / n, aa += fa * fa / n, b += fb / n, bb += fb * fb / n, c += fc / n, cc += fc * fc / n;
        bc += fb * fc / n;
      }
      const double pooled = (b + c) / 2;
      const double janon_index = (bc - pooled * pooled) / ((bb + cc) / 2 - pooled * pooled);
      const double mean = (a + b) / 2;
      double share = 0;
      for (std::size_t row = 0; row < rows; ++row) {
        share += (outputs[row * width + 1] - mean) * (outputs[row * width + 2 + i] - outputs[row * width]) / n;
      }
      ours[i].add((*indices)[i].first_order, known.first_order[i]);
      janon[i].add(SensitivityIndex{janon_index, 0, 0}, 0);
      const double saltelli_index = share / ((aa + bb) / 2 - mean * mean);
      saltelli[i].add(SensitivityIndex{saltelli_index, 0, 0}, 0);
    }
  }
  // The spread of 150 estimates is right to 1 / sqrt(300), and the three have the same rows.
  for (std::size_t i = 0; i < known.inputs(); ++i) {
    EXPECT_LE(ours[i].spread(), 1.15 * janon[i].spread()) << i;
    EXPECT_LE(ours[i].spread(), 1.15 * saltelli[i].spread() + 1e-9) << i;
  }
}

TEST(PickFreeze, ShiftAndScaleOfTheOutputDoNotMatter) {
  std::vector<double> outputs = design_of(ishigami(), 300, 4);
  const auto before = pick_freeze_indices(outputs, 4, {});
  for (double& y : outputs) y = 1e6 + 1e3 * y;
  const auto after = pick_freeze_indices(outputs, 4, {});
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR((*before)[i].first_order.estimate, (*after)[i].first_order.estimate, 1e-9);
    EXPECT_NEAR((*before)[i].total.high, (*after)[i].total.high, 1e-9);
  }
}

TEST(PickFreeze, TheSameSeedGivesTheSameIntervalAndAnotherAnother) {
  const std::vector<double> outputs = design_of(cliffs(), 300, 4);
  const auto one = pick_freeze_indices(outputs, 3, {0.95, 1});
  const auto again = pick_freeze_indices(outputs, 3, {0.95, 1});
  const auto other = pick_freeze_indices(outputs, 3, {0.95, 2});
  EXPECT_EQ((*one)[0].total, (*again)[0].total);
  EXPECT_EQ((*one)[0].total.estimate, (*other)[0].total.estimate);
  EXPECT_NE((*one)[0].total.high, (*other)[0].total.high);
}

TEST(PickFreeze, SaysNothingOfFewRowsOrAConstant) {
  const std::vector<double> outputs = design_of(cliffs(), least_sensitivity_sample, 4);
  EXPECT_TRUE(pick_freeze_indices(outputs, 3, {}));
  EXPECT_FALSE(pick_freeze_indices(std::span(outputs).first(outputs.size() - 5), 3, {}));
  EXPECT_FALSE(pick_freeze_indices(std::vector<double>(500, 0.1), 3, {}));
  EXPECT_FALSE(pick_freeze_indices({}, 3, {}));
}

TEST(PickFreeze, RefusesWhatIsNoTable) {
  EXPECT_THROW(pick_freeze_indices(std::vector<double>(7), 3, {}), std::invalid_argument);
  EXPECT_THROW(pick_freeze_indices(std::vector<double>(8), 0, {}), std::invalid_argument);
}

}  // namespace
}  // namespace steerstat
