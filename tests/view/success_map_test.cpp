#include "view/success_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "../report/sample_comparison.hpp"

namespace steerstat {
namespace {

using ::testing::HasSubstr;
using testing_report::drawn_spec;
using testing_report::finished;
using testing_report::Finished;

std::uint64_t total(const std::vector<std::uint64_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

SuccessMap map_of(const Finished& made, const char* x, const char* y) {
  return success_map({made.study, made.result, made.parameters}, x, y);
}

TEST(SuccessMap, CountsEveryTrialOnceAndItsSuccessWhereItIs) {
  Finished made = finished(drawn_spec(2000));
  for (std::size_t row = 0; row < 2000; ++row) {  // converges in one corner alone
    const bool corner = made.parameters[0][row] < 0.9 && made.parameters[1][row] > 0.03;
    made.result.trials.outcomes[row].status = corner ? Status::converged : Status::timeout;
  }
  const SuccessMap map = map_of(made, "plant.m1", "plant.f2");
  EXPECT_EQ(map.of, 2000U);
  EXPECT_EQ(map.counts.outside, 0U);
  EXPECT_EQ(total(map.counts.trials), 2000U);
  ASSERT_EQ(map.x.bins(), 40U);
  for (std::size_t j = 0; j < map.y.bins(); ++j) {
    for (std::size_t i = 0; i < map.x.bins(); ++i) {
      const std::size_t at = j * map.x.bins() + i;
      if (map.x.edges[i + 1] <= 0.9 && map.y.edges[j] >= 0.03) {
        EXPECT_EQ(map.counts.successes[at], map.counts.trials[at]);
      }
      if (map.x.edges[i] >= 0.9 || map.y.edges[j + 1] <= 0.03) {
        EXPECT_EQ(map.counts.successes[at], 0U);
      }
    }
  }
}

TEST(SuccessMap, IsTheSameTurnedOver) {
  const Finished made = finished(drawn_spec(500));
  const SuccessMap map = map_of(made, "plant.m1", "plant.f2");
  const SuccessMap turned = map_of(made, "plant.f2", "plant.m1");
  for (std::size_t i = 0; i < 40; ++i) {
    for (std::size_t j = 0; j < 40; ++j) {
      EXPECT_EQ(map.counts.trials[j * 40 + i], turned.counts.trials[i * 40 + j]);
    }
  }
}

TEST(SuccessMap, SaysHowManyTrialsLieBeyondAnUnboundedAxis) {
  const Finished made = finished(R"({"plant": {"m1": {"uniform": [0.8, 1.2]}},
    "initial_state": {"q2_dot": {"normal": {"mean": 0, "std": 0.1}}}, "sampling": {"trials": 5000}})");
  const SuccessMap map = map_of(made, "plant.m1", "initial_state.q2_dot");
  EXPECT_GT(map.counts.outside, 0U);
  EXPECT_LE(map.counts.outside, 10U);
  EXPECT_EQ(total(map.counts.trials) + map.counts.outside, 5000U);
}

TEST(SuccessMap, HasTheLevelsOfASweep) {
  const Finished made =
      finished(drawn_spec(100, R"(, "controller": {"contraction": {"eta1": {"sweep": [0.6, 0.4]}}})"));
  const SuccessMap map = map_of(made, "controller.contraction.eta1", "plant.m1");
  EXPECT_EQ(map.x.levels, (std::vector<double>{0.4, 0.6}));
  EXPECT_EQ(map.of, 200U);
  EXPECT_EQ(total(map.counts.trials), 200U);
}

TEST(SuccessMap, RefusesAxesThatDoNotVaryWithWhatWasMeant) {
  const Finished made = finished(drawn_spec(10));
  const auto refusal = [&](const char* x, const char* y) -> std::string {
    try {
      map_of(made, x, y);
    } catch (const BadUsage& refused) {
      return refused.what();
    }
    return "";
  };
  EXPECT_THAT(refusal("plant.m", "plant.f2"), HasSubstr("did you mean plant.m1?"));
  EXPECT_THAT(refusal("plant.m1", "sensor.noise.q1"), HasSubstr("does not vary"));
  EXPECT_THAT(refusal("plant.m1", "plant.m1"), HasSubstr("both axes"));
}

}  // namespace
}  // namespace steerstat
