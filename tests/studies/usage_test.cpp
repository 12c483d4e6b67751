#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/instruction_set.hpp"
#include "core/version.hpp"
#include "process.hpp"

namespace steerstat::testing {
namespace {

using ::testing::HasSubstr;

TEST(Usage, HelpOfTheProgramAndOfEveryCommandShowsExamples) {
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {}, {"run"}, {"validate"}, {"show"}, {"replay"}, {"export"}, {"compare"}}) {
    for (const char* flag : {"--help", "-h"}) {
      std::vector<std::string> arguments = command;
      arguments.emplace_back(flag);
      const Ending help = steerstat(arguments);
      EXPECT_EQ(help.exit_code, 0);
      EXPECT_EQ(help.err, "");
      EXPECT_THAT(help.out, HasSubstr("Examples:"));
      EXPECT_THAT(help.out, HasSubstr(command.empty() ? "steerstat run" : "steerstat " + command.front()));
    }
  }
}

TEST(Usage, VersionNamesTheEngineTheCompilerAndTheLibraries) {
  const Ending version = steerstat({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, ::testing::StartsWith("steerstat " + std::string(engine_version()) + "\n"));
  EXPECT_THAT(version.out, ::testing::ContainsRegex("HDF5 [0-9]+\\.[0-9]+"));
  EXPECT_THAT(version.out, ::testing::ContainsRegex("lockstep built for .*portable; (avx512|avx2|portable) here"));
  EXPECT_THAT(version.out, HasSubstr("; " + std::string(name_of(best_instruction_set())) + " here"));
  EXPECT_THAT(version.out, ::testing::ContainsRegex("SUNDIALS [0-9]+\\.[0-9]+"));
}

struct Misuse {
  std::vector<std::string> arguments;
  std::string said;
};

TEST(Usage, EveryMistakeExitsWithTwoAndSaysWhatIsWrong) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", "{}");
  const std::vector<Misuse> misuses{
      {{}, "no command"},
      {{"rnu", spec}, "there is no command rnu; did you mean run?"},
      {{"--verison"}, "there is no option --verison; did you mean --version?"},
      {{"run"}, "SPEC is required"},
      {{"run", spec, "--thread", "2"}, "run does not take --thread; did you mean --threads?"},
      {{"run", spec, spec}, "run does not take"},
      {{"run", spec, "--threads", "0"}, "--threads"},
      {{"run", spec, "--threads", "-1"}, "--threads"},
      {{"run", spec, "--threads", "1025"}, "--threads"},
      {{"run", spec, "--threads", "two"}, "--threads"},
      {{"run", spec, "--simd", "mmx"}, "there is no instruction set 'mmx'; this machine runs "},
      {{"run", spec, "--simd", ""}, "there is no instruction set ''"},
      {{"run", spec, "--simd", "AVX2"}, "there is no instruction set 'AVX2'"},
      {{"run", spec, "--simd"}, "--simd"},
      {{"run", spec, "-o"}, "--output"},
      {{"run", spec, "-o", "-"}, "name a file"},
      {{"run", spec, "-o", spec}, "is the spec itself"},
      {{"run", spec, "--summary", spec}, "is the spec itself"},
      {{"run", spec, "-o", scratch / "x", "--summary", scratch / "x"}, "give each its own file"},
      {{"show"}, "RESULT is required"},
      {{"show", scratch / "x.h5", "--metric", "success"}, "add --sensitivity"},
      {{"show", scratch / "x.h5", "--sensitivity", "--metric", "sucess"}, "did you mean success?"},
      {{"replay", scratch / "x.h5"}, "--trial is required"},
      {{"replay", scratch / "x.h5", "--trial", "0", "-o", scratch / "x.txt"}, ".csv or .json"},
      {{"export", scratch / "x.h5"}, "--output is required"},
      {{"compare", scratch / "x.h5"}, "B is required"},
      {{"compare", scratch / "x.h5", scratch / "y.h5", "--list", "-1"}, "--list"},
      {{"compare", scratch / "x.h5", scratch / "y.h5", "--list", "100001"}, "--list"},
      {{"export", scratch / "x.h5", "-o", scratch / "x.json"}, ".csv"},
  };
  for (const Misuse& misuse : misuses) {
    const Ending ending = steerstat(misuse.arguments);
    EXPECT_EQ(ending.exit_code, 2) << misuse.said;
    EXPECT_EQ(ending.out, "");
    EXPECT_THAT(ending.err, HasSubstr(misuse.said));
  }
  EXPECT_THAT(scratch.names(), ::testing::ElementsAre("spec.json"));
  EXPECT_EQ(read_file(spec), "{}");
}

TEST(Usage, ThreadsMayBeOneToAThousandAndTwentyFour) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", R"({"horizon": 0.1})");
  for (const char* threads : {"1", "1024"}) {
    EXPECT_EQ(steerstat({"run", spec, "--threads", threads}).exit_code, 0) << threads;
  }
}

TEST(Usage, AnInstructionSetThatThisMachineLacksExitsWithTwoAndTheOthersRun) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", R"({"horizon": 1})");
  for (const std::string_view name : instruction_set_names) {
    const Ending run = steerstat({"run", spec, "--simd", std::string(name), "--summary", "-"});
    if (supports(*instruction_set_named(name))) {
      EXPECT_EQ(run.exit_code, 0) << run.err;
      EXPECT_THAT(run.out, HasSubstr("\"simd\": \"" + std::string(name) + "\""));
    } else {
      EXPECT_EQ(run.exit_code, 2);
      EXPECT_THAT(run.err, HasSubstr("this machine does not run " + std::string(name) + "; it runs "));
    }
  }
}

}  // namespace
}  // namespace steerstat::testing
