#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "json_text.hpp"
#include "process.hpp"
#include "store/result_file.hpp"
#include "study/plan.hpp"

namespace steerstat::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Json = nlohmann::json;

const char* const perturbed = R"({"name": "perturbed",
    "plant": {"m1": {"uniform": [0.8, 1.2]}, "f2": {"uniform": [0, 0.05]}},
    "initial_state": {"q1": {"uniform": [-1, 1]}}, "integrator": {"method": "cvode"}, "horizon": 90, "sampling": {"trials": 40, "seed": 7}})";

void expect_same_rows(const StoredStudy& a, const StoredStudy& b, std::size_t rows) {
  ASSERT_GE(a.result.trials.index.size(), rows);
  ASSERT_GE(b.result.trials.index.size(), rows);
  ASSERT_EQ(a.parameters.size(), b.parameters.size());
  for (std::size_t row = 0; row < rows; ++row) {
    EXPECT_EQ(a.result.trials.index[row], b.result.trials.index[row]);
    EXPECT_TRUE(same_bits(a.result.trials.outcomes[row], b.result.trials.outcomes[row])) << "trial " << row;
    for (std::size_t i = 0; i < a.parameters.size(); ++i) EXPECT_EQ(a.parameters[i][row], b.parameters[i][row]);
  }
}

TEST(RunCommand, OneAndTwoThreadsWriteTheSameTrials) {
  const Scratch scratch;
  for (const char* method : {"cvode", "lockstep"}) {
    std::string text = perturbed;
    text.replace(text.find("cvode"), 5, method);
    text.replace(text.find("40"), 2, "300");
    const std::string spec = scratch.file("spec.json", text);
    ASSERT_EQ(steerstat({"run", spec, "--threads", "1", "-o", scratch / "1.h5"}).exit_code, 0);
    ASSERT_EQ(steerstat({"run", spec, "--threads", "2", "-o", scratch / "2.h5"}).exit_code, 0);
    const StoredStudy one = read_result(scratch / "1.h5");
    EXPECT_TRUE(one.result.complete);
    EXPECT_EQ(one.result.trials.index.size(), 300U);
    expect_same_rows(one, read_result(scratch / "2.h5"), 300);
    const Ending csv = steerstat({"export", scratch / "1.h5", "-o", "-"});
    EXPECT_EQ(csv.out, steerstat({"export", scratch / "2.h5", "-o", "-"}).out);
  }
}

TEST(RunCommand, ShowGivesTheSummaryOfTheRun) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", perturbed);
  const Ending run = steerstat({"run", spec, "-o", scratch / "out.h5", "--summary", scratch / "out.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  Json of_run = json_of(read_file(scratch / "out.json"));
  Json shown = json_of(steerstat({"show", scratch / "out.h5", "--json"}).out);
  EXPECT_EQ(of_run.at("trials").at("completed"), 40);
  EXPECT_GT(of_run.at("performance").at("wall_s"), 0.0);
  of_run.erase("performance");  // of the run, not of the trials
  shown.erase("performance");
  EXPECT_EQ(shown, of_run);

  const Ending table = steerstat({"show", scratch / "out.h5"});
  EXPECT_EQ(table.exit_code, 0);
  EXPECT_THAT(table.out, HasSubstr("perturbed"));
  const auto figures = [](const std::string& text) { return text.substr(0, text.rfind("\n\n")); };
  EXPECT_EQ(figures(table.out), figures(run.out)) << "all but the last paragraph, on performance";
}

TEST(RunCommand, AuditsSixteenTrialsOfAStudyThatDoesNotSayHowMany) {
  const Scratch scratch;
  std::string text = perturbed;
  text.replace(text.find("cvode"), 5, "lockstep");
  const std::string spec = scratch.file("spec.json", text);
  const Ending run = steerstat({"run", spec, "-o", scratch / "out.h5", "--summary", scratch / "out.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json audit = json_of(read_file(scratch / "out.json")).at("audit");
  EXPECT_EQ(audit.at("trials"), 16);
  EXPECT_EQ(audit.at("agree"), 16);
  EXPECT_EQ(audit.at("disagree"), Json::array());
  EXPECT_THAT(run.out, HasSubstr("Audit  16 of 16 trials agree with SUNDIALS at tolerance 1e-11"));
  EXPECT_EQ(json_of(steerstat({"show", scratch / "out.h5", "--json"}).out).at("audit"), audit);
}

TEST(RunCommand, WithoutAnOutputOnlyPrintsTheSummary) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", R"({"name": "single", "horizon": 1})");
  Surroundings surroundings;
  surroundings.directory = scratch / "";
  const Ending run = steerstat({"run", spec}, surroundings);
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("single"));
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(scratch.names(), ElementsAre("spec.json"));
}

TEST(RunCommand, ReadsASpecFromStandardInputAndPrintsTheSummaryAsJson) {
  Surroundings surroundings;
  surroundings.input = R"({"horizon": 1})";
  const Ending run = steerstat({"run", "-", "--summary", "-"}, surroundings);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json summary = json_of(run.out);
  EXPECT_EQ(summary.at("outcomes").at("timeout"), 1);
  EXPECT_TRUE(summary.at("complete").get<bool>());
}

TEST(RunCommand, LooksUpACsvBesideTheSpecWhateverTheWorkingDirectory) {
  const Scratch scratch;
  const Scratch elsewhere;
  scratch.file("trials.csv", "plant.m1,initial_state.q2\n1.1,0.3\n0.9,-0.3\n");
  const std::string spec =
      scratch.file("spec.json", R"({"horizon": 1, "sampling": {"method": "explicit", "file": "trials.csv"}})");
  Surroundings surroundings;
  surroundings.directory = elsewhere / "";
  const Ending run = steerstat({"run", spec, "-o", scratch / "out.h5"}, surroundings);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const StoredStudy stored = read_result(scratch / "out.h5");
  EXPECT_THAT(stored.parameters, ElementsAre(ElementsAre(1.1, 0.9), ElementsAre(0.3, -0.3)));

  surroundings.directory = scratch / "";
  EXPECT_EQ(steerstat({"validate", "spec.json"}, surroundings).exit_code, 0);
  surroundings.input = read_file(spec);
  EXPECT_EQ(steerstat({"validate", "-"}, surroundings).exit_code, 0);
}

TEST(RunCommand, OverwritesAnEarlierResultAndLeavesNothingElseBehind) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", R"({"horizon": 1})");
  scratch.file("out.h5", "something earlier");
  scratch.file("out.json", "something earlier");
  const Ending run = steerstat({"run", spec, "-o", scratch / "out.h5", "--summary", scratch / "out.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(read_result(scratch / "out.h5").result.complete);
  EXPECT_TRUE(json_of(read_file(scratch / "out.json")).at("complete").get<bool>());
  EXPECT_THAT(scratch.names(), ElementsAre("out.h5", "out.json", "spec.json"));
}

TEST(RunCommand, AFullOrClosedStandardOutputExitsWithFourButKeepsTheResult) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", R"({"horizon": 1})");
  Surroundings full;
  full.output_device = "/dev/full";
  Surroundings closed;
  closed.output_closed = true;
  for (const Surroundings& surroundings : {full, closed}) {
    const Ending run = steerstat({"run", spec, "-o", scratch / "out.h5"}, surroundings);
    EXPECT_EQ(run.exit_code, 4);
    EXPECT_THAT(run.err, HasSubstr("standard output"));
    EXPECT_EQ(read_result(scratch / "out.h5").result.trials.index.size(), 1U);
    EXPECT_EQ(steerstat({"show", scratch / "out.h5"}, surroundings).exit_code, 4);
    EXPECT_EQ(steerstat({"--help"}, surroundings).exit_code, 4);
    EXPECT_EQ(steerstat({"--version"}, surroundings).exit_code, 4);
    EXPECT_EQ(steerstat({"validate", spec}, surroundings).exit_code, 4);
    EXPECT_EQ(steerstat({"export", scratch / "out.h5", "-o", "-"}, surroundings).exit_code, 4);
    EXPECT_EQ(steerstat({"replay", scratch / "out.h5", "--trial", "0"}, surroundings).exit_code, 4);
  }
}

TEST(RunCommand, AReaderThatLeavesEarlyIsNoNews) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", R"({"horizon": 300})");
  ASSERT_EQ(steerstat({"run", spec, "-o", scratch / "out.h5"}).exit_code, 0);
  const std::string command = std::string("set -o pipefail; ") + STEERSTAT_PROGRAM + " replay " + (scratch / "out.h5") +
                              " --trial 0 | head -n 1";
  const Ending ending = Process("/bin/bash", {"-c", command}).wait();
  EXPECT_EQ(ending.exit_code, 4);
  EXPECT_EQ(ending.out, "t,q1,q2,q1_dot,q2_dot,a,tau,phase\n");
  EXPECT_EQ(ending.err, "");
}

TEST(RunCommand, WritesASummaryToADeviceInPlace) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", R"({"horizon": 1})");
  EXPECT_EQ(steerstat({"run", spec, "--summary", "/dev/null"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  EXPECT_EQ(steerstat({"run", spec, "--summary", "/dev/full"}).exit_code, 4);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST(RunCommand, WritesThroughALink) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", R"({"horizon": 1})");
  scratch.file("target.json", "");
  std::filesystem::create_symlink("target.json", scratch / "link.json");
  ASSERT_EQ(steerstat({"run", spec, "--summary", scratch / "link.json"}).exit_code, 0);
  EXPECT_TRUE(std::filesystem::is_symlink(scratch / "link.json"));
  EXPECT_TRUE(json_of(read_file(scratch / "target.json")).at("complete").get<bool>());
}

TEST(ValidateCommand, TellsWhatWouldBeRun) {
  const Scratch scratch;
  const Ending ending = steerstat({"validate", scratch.file("spec.json", perturbed)});
  EXPECT_EQ(ending.exit_code, 0);
  EXPECT_EQ(ending.err, "");
  EXPECT_THAT(ending.out, HasSubstr("perturbed"));
  EXPECT_THAT(ending.out, HasSubstr("40"));
  EXPECT_THAT(ending.out, HasSubstr("plant.m1, plant.f2, initial_state.q1"));
}

TEST(ValidateCommand, AcceptsEveryShippedSpec) {
  int specs = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(STEERSTAT_SOURCE_DIR "/studies/specs")) {
    if (entry.path().extension() != ".json" || entry.path().stem().extension() == ".summary") continue;
    EXPECT_EQ(steerstat({"validate", entry.path().string()}).exit_code, 0) << entry.path();
    ++specs;
  }
  EXPECT_GE(specs, 30);
}

}  // namespace
}  // namespace steerstat::testing
