#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "json_text.hpp"
#include "process.hpp"

namespace steerstat::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// Friction on the passive joint alone has a cliff at about 0.02; friction on the other hardly matters.
constexpr const char* cliff_spec = R"({"name": "cliff", "plant": {"f1": {"uniform": [0, 0.005]},
    "f2": {"uniform": [0, 0.04]}}, "horizon": 200, "audit": {"trials": 0}, "sampling": {"method": ")";

TEST(ShowSensitivity, NamesTheFrictionThatHasACliff) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", std::string(cliff_spec) + R"(monte_carlo", "trials": 400}})");
  ASSERT_EQ(steerstat({"run", spec, "-o", scratch / "r.h5", "--no-progress"}).exit_code, 0);
  const Ending shown = steerstat({"show", scratch / "r.h5", "--sensitivity", "--json"});
  EXPECT_EQ(shown.exit_code, 0);
  const json report = json_of(shown.out);
  EXPECT_EQ(report["sobol_indices"], nullptr);
  const json& outputs = report["given_data"]["outputs"];
  ASSERT_EQ(outputs.size(), 2U);
  EXPECT_EQ(outputs[0]["metric"], "success");
  EXPECT_EQ(outputs[0]["trials"], 400);
  EXPECT_EQ(outputs[0]["inputs"][1]["input"], "plant.f2");
  EXPECT_GT(outputs[0]["inputs"][1]["ci_low"].get<double>(), 0.5);
  EXPECT_LT(outputs[0]["inputs"][0]["ci_high"].get<double>(), 0.5);
  EXPECT_EQ(outputs[1]["metric"], "settling_time");
  EXPECT_EQ(steerstat({"show", scratch / "r.h5", "--sensitivity", "--json"}).out, shown.out);

  const Ending table = steerstat({"show", scratch / "r.h5", "--sensitivity", "--metric", "end_time"});
  EXPECT_EQ(table.exit_code, 0);
  EXPECT_THAT(table.out, HasSubstr("end_time"));
  EXPECT_THAT(table.out, ::testing::Not(HasSubstr("settling_time")));
  EXPECT_LT(table.out.find("plant.f2"), table.out.find("plant.f1"));
}

TEST(ShowSensitivity, HasTheSummarysSobolIndicesToo) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", std::string(cliff_spec) + R"(sobol_indices", "trials": 100}})");
  ASSERT_EQ(
      steerstat({"run", spec, "-o", scratch / "r.h5", "--summary", scratch / "s.json", "--no-progress"}).exit_code, 0);
  const json summary = json_of(read_file(scratch / "s.json"));
  EXPECT_EQ(summary["trials"]["completed"], 400);
  const json report = json_of(steerstat({"show", scratch / "r.h5", "--sensitivity", "--json"}).out);
  EXPECT_EQ(report["sobol_indices"], summary["sensitivity"]);
  EXPECT_EQ(report["given_data"]["outputs"][0]["trials"], 200);
  EXPECT_GT(summary["sensitivity"]["success"][1]["total_ci_low"].get<double>(), 0.5);
}

}  // namespace
}  // namespace steerstat::testing
