#include "sampling/importance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/normal.hpp"
#include "sampling/monte_carlo.hpp"

namespace steerstat {
namespace {

const std::vector<std::string> three_names{"a", "b", "c"};

Importance sample_design(double nominal = 0.25) {
  return {7,
          three_names,
          {{(1.0 - nominal) * 0.6, {{0, 1.5, 0.7}, {2, -1.0, 1.0}}}, {(1.0 - nominal) * 0.4, {{1, 0.0, 2.0}}}}};
}

TEST(Importance, DrawsItsNominalShareAsMonteCarloDoesToTheBit) {
  const Importance design = sample_design();
  const MonteCarlo plain(7, three_names);
  constexpr std::uint64_t draws = 20'000;
  std::uint64_t nominal = 0;
  for (std::uint64_t draw = 0; draw < draws; ++draw) {
    if (!design.is_nominal(draw)) continue;
    ++nominal;
    for (std::size_t i = 0; i < three_names.size(); ++i)
      ASSERT_EQ(design.coordinate(draw, i), plain.coordinate(draw, i));
  }
  const double n = draws;
  EXPECT_NEAR(static_cast<double>(nominal) / n, 0.25, 4.0 * std::sqrt(0.25 * 0.75 / n));
}

TEST(Importance, PlacesTheSameBitsThatItsCoordinatesHave) {
  const Importance design = sample_design();
  std::vector<double> point(three_names.size());
  for (std::uint64_t draw = 0; draw < 200; ++draw) {
    design.place(draw, point);
    for (std::size_t i = 0; i < three_names.size(); ++i) ASSERT_EQ(point[i], design.coordinate(draw, i));
  }
}

TEST(Importance, WeighsADrawByTheDensitiesThere) {
  const Importance design = sample_design();
  const auto density = [](double z, double mean, double std) {
    const double y = (z - mean) / std;
    return std::exp(-0.5 * y * y) / std;
  };
  for (std::uint64_t draw = 0; draw < 500; ++draw) {
    std::vector<double> z;
    for (std::size_t i = 0; i < three_names.size(); ++i) z.push_back(normal_quantile(design.coordinate(draw, i)));
    const double first = density(z[0], 1.5, 0.7) / density(z[0], 0, 1) * density(z[2], -1, 1) / density(z[2], 0, 1);
    const double second = density(z[1], 0, 2) / density(z[1], 0, 1);
    const double weight = 1.0 / (0.25 + 0.75 * (0.6 * first + 0.4 * second));
    // A u near 1 tells less of its z than 1e-15: at z = 5 about 1e-16 / phi(5), times z.
    ASSERT_NEAR(design.weight(draw) / weight, 1.0, 1e-8) << draw;
  }
}

TEST(Importance, WeightsAverageToOneAndStayBelowTheInverseOfTheNominalShare) {
  const Importance design = sample_design(0.1);
  constexpr std::uint64_t draws = 50'000;
  double sum = 0.0;
  double squares = 0.0;
  for (std::uint64_t draw = 0; draw < draws; ++draw) {
    const double weight = design.weight(draw);
    ASSERT_GT(weight, 0.0);
    ASSERT_LE(weight, 10.0 * (1.0 + 1e-15));
    sum += weight;
    squares += weight * weight;
  }
  const double n = draws;
  EXPECT_NEAR(sum / n, 1.0, 4.0 * std::sqrt((squares / n - 1.0) / n));
}

TEST(Importance, MeansUnderItsWeightsAreThoseOfPlainDraws) {
  const Importance design = sample_design();
  constexpr std::uint64_t draws = 50'000;
  const double n = draws;
  for (std::size_t i = 0; i < three_names.size(); ++i) {
    double mean = 0.0;  // of an indicator with probability 0.9
    double squares = 0.0;
    for (std::uint64_t draw = 0; draw < draws; ++draw) {
      const double value = design.coordinate(draw, i) < 0.9 ? design.weight(draw) : 0.0;
      mean += value / n;
      squares += value * value / n;
    }
    EXPECT_NEAR(mean, 0.9, 4.0 * std::sqrt((squares - mean * mean) / n)) << three_names[i];
  }
}

TEST(Importance, StaysStrictlyInsideTheUnitCubeHoweverFarItLooks) {
  const Importance design(1, three_names, {{0.9, {{0, 6.0, 4.0}, {1, -6.0, 4.0}}}});
  for (std::uint64_t draw = 0; draw < 5'000; ++draw) {
    for (std::size_t i = 0; i < 2; ++i) {
      ASSERT_GT(design.coordinate(draw, i), 0.0);
      ASSERT_LT(design.coordinate(draw, i), 1.0);
    }
    ASSERT_TRUE(std::isfinite(design.weight(draw)));
  }
}

}  // namespace
}  // namespace steerstat
