#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "json_text.hpp"
#include "process.hpp"

namespace steerstat::testing {
namespace {

using ::testing::HasSubstr;

constexpr const char* small_spec = R"({"kind": "approximation", "name": "small", "sampling": {"trials": 20},
  "cycle": {"amplitude": {"sweep": [25, 50]}, "period": {"sweep": [1, 2]}}})";

TEST(ApproximationCommand, RunsPrintsTablesAndWritesItsSummary) {
  const Scratch scratch;
  const std::string file = scratch.file("spec.json", small_spec);
  const Ending text = steerstat({"run", file, "--summary", scratch / "summary.json"});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("Fitted order"));
  const auto json = json_of(read_file(scratch / "summary.json"));
  EXPECT_EQ(json.at("cells").size(), 4U);
  const Ending printed = steerstat({"run", file, "--summary", "-"});
  EXPECT_EQ(json_of(printed.out), json);
  EXPECT_THAT(steerstat({"validate", file}).out, HasSubstr("80 (4 cells of 20)"));
}

TEST(ApproximationCommand, RefusesAResultFileAndBadSpecsWithTwo) {
  const Scratch scratch;
  const std::string file = scratch.file("spec.json", small_spec);
  const Ending kept = steerstat({"run", file, "-o", scratch / "result.h5"});
  EXPECT_EQ(kept.exit_code, 2);
  EXPECT_THAT(kept.err, HasSubstr("-o: an approximation study keeps no trials"));
  const Ending bad = steerstat({"run", scratch.file("bad.json", R"({"kind": "approximation", "cycle": {"q2": 2}})")});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_THAT(bad.err, HasSubstr("/cycle/q2"));
  EXPECT_THAT(scratch.names(), ::testing::ElementsAre("bad.json", "spec.json"));
}

}  // namespace
}  // namespace steerstat::testing
