#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "fields.hpp"
#include "robot/linearised.hpp"
#include "robot/plant.hpp"

namespace steerstat {
namespace {

using testing::bracket;
using testing::drift_of;
using testing::input_of;

using Matrix = std::array<std::array<double, 4>, 4>;

Matrix with_columns(const std::array<State<double>, 4>& columns) {
  Matrix m{};
  for (std::size_t k = 0; k < 4; ++k) {
    m[0][k] = columns[k].q1;
    m[1][k] = columns[k].q2;
    m[2][k] = columns[k].q1_dot;
    m[3][k] = columns[k].q2_dot;
  }
  return m;
}

double determinant(Matrix m) {  // Gaussian elimination with pivoting
  double result = 1.0;
  for (std::size_t k = 0; k < 4; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < 4; ++i) {
      if (std::abs(m[i][k]) > std::abs(m[pivot][k])) pivot = i;
    }
    if (m[pivot][k] == 0.0) return 0.0;
    if (pivot != k) {
      std::swap(m[pivot], m[k]);
      result = -result;
    }
    result *= m[k][k];
    for (std::size_t i = k + 1; i < 4; ++i) {
      const double factor = m[i][k] / m[k][k];
      for (std::size_t j = k; j < 4; ++j) m[i][j] -= factor * m[k][j];
    }
  }
  return result;
}

const PlantParameters<double> plant{1.3, 0.8, 0.6, 0.9, 0.0, 0.0};
const auto f = drift_of(plant);
const auto g = input_of(plant);
const auto fg = bracket(f, g);
const auto gfg = bracket(g, fg);
const auto fgfg = bracket(f, gfg);

RegularPoint<double> regular_point(double q2, double q2_dot) {
  return {0.3, q2, q2_dot, std::sin(q2), std::cos(q2), coupling(plant)};
}

State<double> state_of(const RegularPoint<double>& x0) {
  return {x0.q1, x0.q2, 0.0, x0.q2_dot};
}

const std::vector<RegularPoint<double>> points{regular_point(0.4, 0.3),  regular_point(2.1, -0.5),
                                               regular_point(-2.5, 1.1), regular_point(-0.9, -0.2),
                                               regular_point(7.0, 0.05), regular_point(1.2, 0.0)};

TEST(Accessibility, MatrixIsTheBracketsOfThePlantUnderLinearisingFeedback) {
  for (const RegularPoint<double>& x0 : points) {
    const State<double> x = state_of(x0);
    const Matrix brackets = with_columns({f(x), g(x), fg(x), gfg(x)});
    const Matrix printed = accessibility_matrix(x0);
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(printed[i][k], brackets[i][k], 1e-14) << i << ',' << k;
    }
  }
}

TEST(Accessibility, DeterminantOfTheBracketsIsMinusTwoKSquaredCosSinSpeed) {
  for (const RegularPoint<double>& x0 : points) {
    const State<double> x = state_of(x0);
    const double expected = -2.0 * std::pow(coupling(plant), 2) * std::cos(x0.q2) * std::sin(x0.q2) * x0.q2_dot;
    EXPECT_NEAR(determinant(with_columns({f(x), g(x), fg(x), gfg(x)})), expected, 1e-14);
    EXPECT_NEAR(accessibility_determinant(x0), expected, 1e-16);
  }
}

TEST(Accessibility, AFurtherBracketGivesRankAtTheSingularAnglesWhileTheLinkTurns) {
  for (const double q2 : {0.0, std::numbers::pi / 2, std::numbers::pi, -std::numbers::pi / 2}) {
    const State<double> x = state_of(regular_point(q2, 0.4));
    EXPECT_NEAR(determinant(with_columns({f(x), g(x), fg(x), gfg(x)})), 0.0, 1e-15);
    EXPECT_GT(std::abs(determinant(with_columns({f(x), g(x), fg(x), fgfg(x)}))), 1e-3);
  }
}

TEST(Accessibility, AtRestTheMatrixOfEquilibriaIsSingularAtMultiplesOfAQuarterTurnOnly) {
  for (const double q2 : {0.0, std::numbers::pi / 2, std::numbers::pi}) {
    const State<double> x = state_of(regular_point(q2, 0.0));
    EXPECT_NEAR(determinant(with_columns({g(x), fg(x), gfg(x), fgfg(x)})), 0.0, 1e-15);
  }
  for (const double q2 : {0.2, 1.4, 1.7, 3.0, -0.2}) {
    const State<double> x = state_of(regular_point(q2, 0.0));
    EXPECT_GT(std::abs(determinant(with_columns({g(x), fg(x), gfg(x), fgfg(x)}))), 1e-3);
  }
}

TEST(Accessibility, NothingMovesALinkAtRestStretchedOrFolded) {
  for (const double q2 : {0.0, std::numbers::pi}) {
    for (const double a : {-3.0, 0.5, 10.0}) {
      const State<double> rates = testing::steered_plant(plant, a)(state_of(regular_point(q2, 0.0)));
      EXPECT_NEAR(rates.q2_dot, 0.0, 1e-14);
      EXPECT_EQ(rates.q2, 0.0);
    }
  }
}

}  // namespace
}  // namespace steerstat
