#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "json_text.hpp"
#include "process.hpp"

namespace steerstat::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

/// A study of which every trial converges, with these gates.
std::string spec_with(const std::string& gates, int trials = 100) {
  return R"({"name": "sure", "plant": {"m1": {"uniform": [0.99, 1.01]}}, "audit": {"trials": 0},
             "sampling": {"trials": )" +
         std::to_string(trials) + R"(}, "gates": [)" + gates + "]}";
}

const char* const passing = R"({"metric": "success_rate", "expr": "ci_low >= 0.9"})";
const char* const failing = R"({"metric": "settling_time", "expr": "p95 < 1"})";
const char* const undecided = R"({"metric": "success_rate", "expr": "ci_low >= 0.999"})";

TEST(GatesCommand, TheWorstVerdictIsTheExitCode) {
  const Scratch scratch;
  const auto exit_code = [&](const std::string& gates) {
    return steerstat({"run", scratch.file("spec.json", spec_with(gates))}).exit_code;
  };
  const auto list = [](const char* a, const char* b) { return std::string(a) + ", " + b; };
  EXPECT_EQ(exit_code(""), 0);
  EXPECT_EQ(exit_code(passing), 0);
  EXPECT_EQ(exit_code(list(passing, undecided)), 3);
  EXPECT_EQ(exit_code(list(undecided, failing)), 1);
  EXPECT_EQ(exit_code(list(passing, failing)), 1);
}

TEST(GatesCommand, WritesEverythingWhateverTheVerdict) {
  const Scratch scratch;
  const std::string spec =
      scratch.file("spec.json", spec_with(std::string(passing) + ", " + failing + ", " + undecided));
  const Ending run = steerstat({"run", spec, "-o", scratch / "a.h5", "--summary", scratch / "a.json", "--junit",
                                scratch / "a.xml", "--markdown", scratch / "a.md"});
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_THAT(scratch.names(), ElementsAre("a.h5", "a.json", "a.md", "a.xml", "spec.json"));
  const Json gates = json_of(read_file(scratch / "a.json")).at("gates");
  ASSERT_EQ(gates.size(), 3U);
  EXPECT_EQ(gates[0].at("verdict"), "pass");
  EXPECT_EQ(gates[1].at("verdict"), "fail");
  EXPECT_EQ(gates[2].at("verdict"), "inconclusive");
  EXPECT_THAT(run.out, HasSubstr("inconclusive  success_rate ci_low >= 0.999"));
  EXPECT_THAT(read_file(scratch / "a.xml"), HasSubstr("tests=\"3\" failures=\"1\" errors=\"1\""));
  EXPECT_THAT(read_file(scratch / "a.md"), HasSubstr("## sure: ❌ fail"));

  const Ending show =
      steerstat({"show", scratch / "a.h5", "--json", "--junit", scratch / "b.xml", "--markdown", scratch / "b.md"});
  EXPECT_EQ(show.exit_code, 0) << "show shows; run judges";
  EXPECT_EQ(json_of(show.out).at("gates"), gates);
  EXPECT_EQ(read_file(scratch / "b.xml"), read_file(scratch / "a.xml"));
}

TEST(GatesCommand, AnUnknownNameIsFoundBeforeAnythingRuns) {
  const Scratch scratch;
  const std::string spec =
      scratch.file("spec.json", spec_with(R"({"metric": "succes_rate", "expr": "ci_low >= 0.9"})", 1000000));
  const Ending run = steerstat({"run", spec, "-o", scratch / "a.h5"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("/gates/0/metric: \"succes_rate\" is unknown"));
  EXPECT_THAT(run.err, HasSubstr("did you mean \"success_rate\"?"));
  EXPECT_THAT(scratch.names(), ElementsAre("spec.json"));
}

TEST(GatesCommand, OutputsThatCannotBeWrittenOrCollideAreFoundFirst) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", spec_with(passing, 1000000));
  for (const char* option : {"--junit", "--markdown"}) {
    EXPECT_EQ(steerstat({"run", spec, option, scratch / "absent/x"}).exit_code, 4) << option;
    EXPECT_EQ(steerstat({"run", spec, option, ""}).exit_code, 4) << option;
    EXPECT_EQ(steerstat({"run", spec, option, "-"}).exit_code, 2) << option;
    EXPECT_EQ(steerstat({"run", spec, option, spec}).exit_code, 2) << option;
    const Ending both = steerstat({"run", spec, option, scratch / "x", "--summary", scratch / "./x"});
    EXPECT_EQ(both.exit_code, 2) << option;
    EXPECT_THAT(both.err, HasSubstr("each its own file"));
  }
  EXPECT_THAT(scratch.names(), ElementsAre("spec.json"));
}

TEST(GatesCommand, AnInterruptionIsWhatTheExitCodeTells) {
  const Scratch scratch;
  const std::string spec =
      scratch.file("spec.json", R"({"plant": {"f2": {"uniform": [0.03, 0.05]}}, "integrator": {"method": "cvode"},
                       "sampling": {"trials": 1000000}, "gates": [{"metric": "success_rate", "expr": "ci_low > 0.9"},
                       {"metric": "timeout_rate", "expr": "count > 5"}]})");
  Surroundings surroundings;
  surroundings.columns = 80;
  Process process(STEERSTAT_PROGRAM, {"run", spec, "--summary", scratch / "a.json", "--threads", "1"}, surroundings);
  ASSERT_TRUE(process.shows("/s  "));
  process.send(SIGINT);
  EXPECT_EQ(process.wait().exit_code, 130);
  const Json summary = json_of(read_file(scratch / "a.json"));
  EXPECT_FALSE(summary.at("complete").get<bool>());
  for (const Json& gate : summary.at("gates")) EXPECT_NE(gate.at("verdict"), "pass");
}

TEST(BaselineCommand, GatesOnADrop) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", spec_with("", 400));
  ASSERT_EQ(steerstat({"run", spec, "--summary", scratch / "before.json"}).exit_code, 0);
  const Ending same = steerstat({"run", spec, "--baseline", scratch / "before.json", "--summary", scratch / "a.json"});
  EXPECT_EQ(same.exit_code, 0) << same.err << same.out;
  const Json summary = json_of(read_file(scratch / "a.json"));
  EXPECT_EQ(summary.at("baseline").at("converged"), 400);
  EXPECT_EQ(summary.at("gates").at(0).at("expr"), "drop < 0.02");
  EXPECT_THAT(same.out, HasSubstr("pass     success_rate drop < 0.02"));

  Json changed = json_of(read_file(spec));
  changed["controller"]["alignment"]["kd"] = 1;
  const Ending dropped =
      steerstat({"run", scratch.file("kd.json", text_of(changed)), "--baseline", scratch / "before.json"});
  EXPECT_EQ(dropped.exit_code, 1) << dropped.out;

  changed = json_of(read_file(spec));
  changed["sampling"]["trials"] = 20;
  const Ending starved =
      steerstat({"run", scratch.file("few.json", text_of(changed)), "--baseline", scratch / "before.json"});
  EXPECT_EQ(starved.exit_code, 3) << starved.out;
}

TEST(BaselineCommand, RefusesWhatIsNoBaselineBeforeAnythingRuns) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", spec_with("", 1000000));
  const auto refusal = [&](const std::string& baseline) {
    const Ending run = steerstat({"run", spec, "--baseline", baseline, "-o", scratch / "a.h5"});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_EQ(run.out, "");
    return run.err;
  };
  EXPECT_THAT(refusal(scratch / "absent.json"), HasSubstr("absent.json (No such file or directory)"));
  EXPECT_THAT(refusal(scratch.file("text.json", "not JSON")), HasSubstr("line 1"));
  EXPECT_THAT(refusal(scratch.file("empty.json", "{}")), HasSubstr("\"outcomes\" is missing"));
  EXPECT_THAT(refusal(spec), HasSubstr("is not the summary of a study"));

  const std::string other = scratch.file("other.json", R"({"goal": {"q2": 0.5}, "horizon": 1})");
  ASSERT_EQ(steerstat({"run", other, "--summary", scratch / "other-summary.json"}).exit_code, 0);
  EXPECT_THAT(refusal(scratch / "other-summary.json"), HasSubstr("is of other trials than this study's"));
  EXPECT_THAT(scratch.names(), Not(::testing::Contains("a.h5")));
}

TEST(BaselineCommand, DoesNotOverwriteItsBaseline) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", spec_with("", 10));
  ASSERT_EQ(steerstat({"run", spec, "--summary", scratch / "a.json"}).exit_code, 0);
  const Ending run = steerstat({"run", spec, "--baseline", scratch / "a.json", "--summary", scratch / "a.json"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("is the baseline itself and would be overwritten"));
}

}  // namespace
}  // namespace steerstat::testing
