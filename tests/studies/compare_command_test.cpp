#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "json_text.hpp"
#include "process.hpp"

namespace steerstat::testing {
namespace {

using ::testing::HasSubstr;

/// Runs a study of friction with `more` in its spec. @return the result file
std::string run_study(const Scratch& scratch, const std::string& name, const std::string& more) {
  const std::string spec = scratch.file(
      name + ".json", R"({"plant": {"f2": {"uniform": [0, 0.05]}}, "audit": {"trials": 0}, )" + more + "}");
  const std::string result = scratch / (name + ".h5");
  EXPECT_EQ(steerstat({"run", spec, "-o", result, "--no-progress"}).exit_code, 0);
  return result;
}

TEST(CompareCommand, PairsTwoRunsAndItsDiscordantTrialsReplayToTheirEnds) {
  const Scratch scratch;
  const std::string a = run_study(scratch, "a", R"("sampling": {"trials": 40})");
  const std::string b =
      run_study(scratch, "b", R"("sampling": {"trials": 60}, "controller": {"contraction": {"eta2": 0.8}})");
  const Ending text = steerstat({"compare", a, b});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("/controller/contraction/eta2  0.6  0.8"));
  EXPECT_THAT(text.out, HasSubstr("only the 40 trials that both have are paired"));

  const Ending ending = steerstat({"compare", a, b, "--json"});
  const auto json = json_of(ending.out);
  EXPECT_EQ(json.at("pairs").at("total"), 40);
  const auto& discordant = json.at("discordant").at("b_only");
  ASSERT_GT(discordant.at("count"), 0) << "eta2 0.8 keeps more speed, so that more trials arrive";
  EXPECT_EQ(discordant.at("count"), json.at("pairs").at("b_only"));
  const std::string trial = std::to_string(discordant.at("indices").front().get<int>());
  for (const auto& [file, status] : {std::pair(a, "timeout"), std::pair(b, "converged")}) {
    const Ending replayed = steerstat({"replay", file, "--trial", trial, "-o", scratch / "trial.csv"});
    EXPECT_EQ(replayed.exit_code, 0);
    EXPECT_THAT(replayed.err, HasSubstr(std::string("(") + status + " at "));
  }
}

TEST(CompareCommand, RefusesStudiesThatShareNoDrawsWithTwoAndEveryReason) {
  const Scratch scratch;
  const std::string a = run_study(scratch, "a", R"("horizon": 1, "sampling": {"trials": 4, "seed": 1})");
  const std::string b =
      run_study(scratch, "b",
                R"("horizon": 1, "sampling": {"trials": 4, "seed": 2}, "initial_state": {"q2": {"uniform": [0, 1]}})");
  const Ending ending = steerstat({"compare", a, b});
  EXPECT_EQ(ending.exit_code, 2);
  EXPECT_EQ(ending.out, "");
  EXPECT_THAT(ending.err, HasSubstr("/sampling/seed: 1 in A, 2 in B"));
  EXPECT_THAT(ending.err, HasSubstr("/initial_state/q2: drawn in B alone"));
}

TEST(CompareCommand, AFileThatIsNoResultFileExitsWithFour) {
  const Scratch scratch;
  const std::string a = run_study(scratch, "a", R"("horizon": 1)");
  for (const std::string& other : {scratch.file("b.h5", "not HDF5"), scratch / "missing.h5"}) {
    EXPECT_EQ(steerstat({"compare", a, other}).exit_code, 4);
    EXPECT_EQ(steerstat({"compare", other, a}).exit_code, 4);
  }
}

}  // namespace
}  // namespace steerstat::testing
