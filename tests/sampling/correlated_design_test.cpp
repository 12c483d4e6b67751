#include "sampling/correlated_design.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/normal.hpp"
#include "sampling/latin_hypercube.hpp"
#include "sampling/monte_carlo.hpp"
#include "sampling/sobol.hpp"

namespace steerstat {
namespace {

constexpr std::uint64_t all_draws = 1U << 14U;
const std::vector<std::string> five_names{"a", "b", "c", "d", "e"};
// a and d, b alone, c and e: two groups of their own.
const std::vector<PairCorrelation> correlated_pairs{{0, 3, 0.6}, {2, 4, -0.8}};

std::shared_ptr<const Design> independent(const std::string& method, std::uint64_t seed = 1) {
  if (method == "sobol") return std::make_shared<Sobol>(seed, five_names);
  if (method == "latin_hypercube") return std::make_shared<LatinHypercube>(all_draws, seed, five_names);
  return std::make_shared<MonteCarlo>(seed, five_names);
}

std::vector<double> coordinates(const Design& design, std::size_t variable) {
  std::vector<double> u(all_draws);
  for (std::uint64_t draw = 0; draw < all_draws; ++draw) u[draw] = design.coordinate(draw, variable);
  return u;
}

double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / n;
    mean_y += y[i] / n;
  }
  double xx = 0.0;
  double yy = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return xy / std::sqrt(xx * yy);
}

std::vector<double> normals(std::vector<double> u) {
  for (double& x : u) x = normal_quantile(x);
  return u;
}

class OfAnyDesign : public ::testing::TestWithParam<std::string> {
 protected:
  const std::shared_ptr<const Design> independent_ = independent(GetParam());
  const CorrelatedDesign design_{independent_, *factorise_correlation(5, correlated_pairs)};
};

TEST_P(OfAnyDesign, CorrelationsOfTheNormalVariablesAreWithinTheirStandardErrors) {
  const double n = all_draws;
  std::vector<std::vector<double>> z;
  for (std::size_t variable = 0; variable < five_names.size(); ++variable) {
    z.push_back(normals(coordinates(design_, variable)));
  }
  for (std::size_t i = 0; i < z.size(); ++i) {
    for (std::size_t j = i + 1; j < z.size(); ++j) {
      const double rho = i == 0 && j == 3 ? 0.6 : (i == 2 && j == 4 ? -0.8 : 0.0);
      EXPECT_NEAR(correlation(z[i], z[j]), rho, 4.5 * (1.0 - rho * rho) / std::sqrt(n)) << i << " and " << j;
    }
  }
}

TEST_P(OfAnyDesign, RankCorrelationsAreThoseOfTheCopula) {
  // Of uniform variables, the correlation is that of the ranks: (6 / pi) asin(rho / 2) [Kruskal 1958]. Its standard
  // error is below that of independent ranks.
  const auto expected = [](double rho) { return 6.0 / std::numbers::pi * std::asin(0.5 * rho); };
  const double bound = 4.5 / std::sqrt(static_cast<double>(all_draws));
  EXPECT_NEAR(correlation(coordinates(design_, 0), coordinates(design_, 3)), expected(0.6), bound);
  EXPECT_NEAR(correlation(coordinates(design_, 2), coordinates(design_, 4)), expected(-0.8), bound);
}

TEST_P(OfAnyDesign, EveryCoordinateStaysUniform) {
  for (std::size_t variable = 0; variable < five_names.size(); ++variable) {
    auto u = coordinates(design_, variable);
    std::sort(u.begin(), u.end());
    double distance = 0.0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      const double middle = (static_cast<double>(i) + 0.5) / static_cast<double>(all_draws);
      distance = std::max(distance, std::abs(u[i] - middle));
    }
    EXPECT_LT(distance, 1.95 / std::sqrt(static_cast<double>(all_draws)));  // exceeded once in a thousand samples
    EXPECT_GT(u.front(), 0.0);
    EXPECT_LT(u.back(), 1.0);
  }
}

TEST_P(OfAnyDesign, VariablesCorrelatedWithNoneBeforeThemKeepTheirBits) {
  for (const std::size_t variable : {0U, 1U, 2U}) {
    EXPECT_EQ(coordinates(design_, variable), coordinates(*independent_, variable));
  }
  for (const std::size_t variable : {3U, 4U}) {
    EXPECT_NE(design_.coordinate(0, variable), independent_->coordinate(0, variable));
  }
}

TEST_P(OfAnyDesign, PlacesTheSameBitsThatItsCoordinatesHave) {
  std::vector<double> point(five_names.size());
  for (std::uint64_t draw = 0; draw < 100; ++draw) {
    design_.place(draw, point);
    for (std::size_t variable = 0; variable < five_names.size(); ++variable) {
      EXPECT_EQ(point[variable], design_.coordinate(draw, variable));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, OfAnyDesign, ::testing::Values("monte_carlo", "latin_hypercube", "sobol"),
                         [](const auto& instance) { return instance.param; });

// The outermost draws that a design has.
class Corner : public Design {
 public:
  [[nodiscard]] double coordinate(std::uint64_t draw, std::size_t) const override {
    return draw == 0 ? 0x1p-53 : 1.0 - 0x1p-53;
  }
};

TEST(CorrelatedDesign, StaysStrictlyInsideWhereExtremesAddUp) {
  const auto factor = factorise_correlation(3, std::vector<PairCorrelation>{{0, 1, 0.7}, {0, 2, 0.7}, {1, 2, 0.7}});
  const CorrelatedDesign design(std::make_shared<Corner>(), *factor);
  for (std::size_t variable = 0; variable < 3; ++variable) {
    EXPECT_EQ(design.coordinate(0, variable), 0x1p-53);
    EXPECT_EQ(design.coordinate(1, variable), 1.0 - 0x1p-53);
  }
}

TEST(CorrelatedDesign, KeepsTheDrawsItHasAlwaysGiven) {
  const CorrelatedDesign design(independent("monte_carlo"), *factorise_correlation(5, correlated_pairs));
  EXPECT_EQ(design.coordinate(0, 3), 0x1.83c8f5a3b2bdep-1);
  EXPECT_EQ(design.coordinate(1, 4), 0x1.23a889f23d93bp-1);
}

}  // namespace
}  // namespace steerstat
