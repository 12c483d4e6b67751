#include "view/thinning.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace steerstat {
namespace {

using ::testing::ElementsAre;

struct Curve {
  std::vector<double> t;
  std::vector<std::vector<double>> columns;
};

/// A slow wave, and in the second column the same with a spike.
Curve wave(std::size_t points) {
  Curve curve{{}, {{}, {}}};
  for (std::size_t i = 0; i < points; ++i) {
    const double t = 0.01 * static_cast<double>(i);
    curve.t.push_back(t);
    curve.columns[0].push_back(std::sin(t));
    curve.columns[1].push_back(std::sin(t) + (i == points / 3 ? 50.0 : 0.0));
  }
  return curve;
}

/// The farthest that lines between kept points pass from the others, computed anew.
double farthest(const Curve& curve, const std::vector<std::size_t>& kept) {
  double result = 0.0;
  for (const std::vector<double>& y : curve.columns) {
    const auto [low, high] = std::minmax_element(y.begin(), y.end());
    for (std::size_t k = 1; k < kept.size(); ++k) {
      const std::size_t a = kept[k - 1];
      const std::size_t b = kept[k];
      for (std::size_t i = a + 1; i < b; ++i) {
        const double line = y[a] + (curve.t[i] - curve.t[a]) / (curve.t[b] - curve.t[a]) * (y[b] - y[a]);
        result = std::max(result, std::abs(y[i] - line) / (*high - *low));
      }
    }
  }
  return result;
}

TEST(Thin, KeepsEveryPointThatMustStayAndNoMoreThanAsked) {
  const Curve curve = wave(3000);
  const std::vector<std::size_t> fixed{0, 700, 701, 1234, 2999};
  const Thinned thinned = thin(curve.t, curve.columns, fixed, 100);
  EXPECT_EQ(thinned.kept.size(), 100U);
  EXPECT_TRUE(std::is_sorted(thinned.kept.begin(), thinned.kept.end()));
  for (const std::size_t point : fixed) {
    EXPECT_TRUE(std::binary_search(thinned.kept.begin(), thinned.kept.end(), point)) << point;
  }
}

TEST(Thin, KeepsASpikeOfASingleSample) {
  const Curve curve = wave(3000);
  const std::vector<std::size_t> fixed{0, 2999};
  const Thinned thinned = thin(curve.t, curve.columns, fixed, 50);
  for (const std::size_t point : {999U, 1000U, 1001U}) {
    EXPECT_TRUE(std::binary_search(thinned.kept.begin(), thinned.kept.end(), point)) << point;
  }
}

TEST(Thin, SaysExactlyHowFarItIsFromWhatItLeftOut) {
  const Curve curve = wave(2000);
  const std::vector<std::size_t> fixed{0, 1999};
  double before = 2.0;
  for (const std::size_t most : {10U, 40U, 160U, 640U}) {
    const Thinned thinned = thin(curve.t, curve.columns, fixed, most);
    EXPECT_NEAR(thinned.largest_deviation, farthest(curve, thinned.kept), 1e-12);
    EXPECT_LT(thinned.largest_deviation, before);
    before = thinned.largest_deviation;
  }
  EXPECT_LT(before, 1e-4);
}

TEST(Thin, KeepsAllOfFewPoints) {
  const Curve curve = wave(20);
  const std::vector<std::size_t> fixed{0, 19};
  EXPECT_EQ(thin(curve.t, curve.columns, fixed, 20).kept.size(), 20U);
  EXPECT_EQ(thin(curve.t, curve.columns, fixed, 20).largest_deviation, 0.0);
  EXPECT_EQ(thin(curve.t, curve.columns, fixed, 19).kept.size(), 19U);
  EXPECT_EQ(thin(curve.t, curve.columns, fixed, 2000).kept.size(), 20U);
}

TEST(Thin, IgnoresWhatIsNotFinite) {
  Curve curve = wave(10);
  curve.columns[1][5] = std::nan("");
  curve.columns[1][6] = INFINITY;
  const std::vector<std::size_t> fixed{0, 9};
  EXPECT_THAT(thin(curve.t, curve.columns, fixed, 2).kept, ElementsAre(0U, 9U));
  EXPECT_TRUE(std::isfinite(thin(curve.t, curve.columns, fixed, 2).largest_deviation));
}

}  // namespace
}  // namespace steerstat
