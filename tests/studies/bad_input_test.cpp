#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "process.hpp"

namespace steerstat::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct BadSpecCase {
  const char* name;
  std::string spec;
  std::vector<std::string> said;  ///< every one of these is in the message
};

void PrintTo(const BadSpecCase& one, std::ostream* out) {
  *out << one.spec.substr(0, 80);
}

class BadSpecText : public ::testing::TestWithParam<BadSpecCase> {};

TEST_P(BadSpecText, IsExplainedWithExitTwoAndNothingWritten) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", GetParam().spec);
  scratch.file("short.csv", "plant.m1,plant.m2\n1,1\n1\n");
  scratch.file("text.csv", "plant.m1\n1.0\nheavy\n");
  scratch.file("unknown.csv", "plant.m9\n1.0\n");
  const std::vector<std::string> before = scratch.names();
  const Ending run = steerstat({"run", spec, "-o", scratch / "out.h5", "--summary", scratch / "out.json"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.out, "");
  for (const std::string& text : GetParam().said) EXPECT_THAT(run.err, HasSubstr(text));
  EXPECT_EQ(scratch.names(), before);
  const Ending validate = steerstat({"validate", spec});
  EXPECT_EQ(validate.exit_code, 2);
  EXPECT_EQ(validate.out, "");
  EXPECT_EQ(validate.err, run.err);
}

std::string sweep_of(int values) {
  std::string text = R"({"sweep": [)";
  for (int i = 1; i <= values; ++i) text += (i > 1 ? ", 0." : "0.") + std::to_string(1000 + i);
  return text + "]}";
}

INSTANTIATE_TEST_SUITE_P(
    Cases, BadSpecText,
    ::testing::Values(
        BadSpecCase{"Empty", "", {"line 1, column 1"}},
        BadSpecCase{"Malformed", "{\n  \"horizon\": 3,\n  \"goal\": {\"q1\" 0}\n}\n", {"line 3, column 17"}},
        BadSpecCase{"NotAnObject", "[1, 2]", {"object"}}, BadSpecCase{"TrailingText", "{} {}", {"line 1, column 4"}},
        BadSpecCase{"LiteralNaN", R"({"horizon": NaN})", {"line 1, column"}},
        BadSpecCase{"LiteralInfinity", R"({"horizon": -Infinity})", {"line 1, column"}},
        BadSpecCase{"OverflowingNumber", R"({"horizon": 1e999})", {"/horizon"}},
        BadSpecCase{"TextNaN", R"({"plant": {"m1": "NaN"}})", {"/plant/m1"}},
        BadSpecCase{"UnknownKey", R"({"horizen": 3})", {"/horizen", "horizon"}},
        BadSpecCase{"UnknownNestedKey",
                    R"({"controller": {"contraction": {"eta3": 0.5}}})",
                    {"/controller/contraction/eta3", "eta"}},
        BadSpecCase{"DuplicateKey", R"({"horizon": 3, "horizon": 4})", {"/horizon"}},
        BadSpecCase{"TextForANumber", R"({"horizon": "long"})", {"/horizon"}},
        BadSpecCase{"NumberForAnObject", R"({"plant": 3})", {"/plant"}},
        BadSpecCase{"NegativeTrials", R"({"sampling": {"trials": -1}})", {"/sampling/trials"}},
        BadSpecCase{"NoTrials", R"({"sampling": {"trials": 0}})", {"/sampling/trials"}},
        BadSpecCase{"FractionalTrials", R"({"sampling": {"trials": 1.5}})", {"/sampling/trials"}},
        BadSpecCase{"HugeTrials", R"({"sampling": {"trials": 1e30}})", {"/sampling/trials"}},
        BadSpecCase{"SeedBeyond64Bits", R"({"sampling": {"seed": 18446744073709551616}})", {"/sampling/seed"}},
        BadSpecCase{"NegativeMass", R"({"plant": {"m1": -1}})", {"/plant/m1"}},
        BadSpecCase{"NegativeNominalMass", R"({"nominal": {"m2": -1}})", {"/nominal/m2"}},
        BadSpecCase{"ZeroD2", R"({"nominal": {"d2": 0}})", {"/nominal/d2"}},
        BadSpecCase{"NegativeFriction", R"({"plant": {"f1": -0.01}})", {"/plant/f1"}},
        BadSpecCase{"GoalOnAnAxis", R"({"goal": {"q1": 0, "q2": 1.5707963267948966}})", {"/goal/q2"}},
        BadSpecCase{"LowAboveHigh",
                    R"({"plant": {"m1": {"uniform": [1.2, 0.8]}}})",
                    {"/plant/m1/uniform: low 1.2 is above high 0.8 (low < high); swap them"}},
        BadSpecCase{"ImpossibleMassDrawn", R"({"plant": {"m1": {"uniform": [-0.1, 1]}}})", {"/plant/m1"}},
        BadSpecCase{"UnboundedMassDrawn", R"({"plant": {"m1": {"normal": {"mean": 1, "std": 0.1}}}})", {"/plant/m1"}},
        BadSpecCase{"EmptySweep", R"({"plant": {"m1": {"sweep": []}}})", {"/plant/m1/sweep"}},
        BadSpecCase{
            "AMillionCells",
            R"({"controller": {"contraction": {"eta1": )" + sweep_of(1000) + R"(, "eta2": )" + sweep_of(1001) + "}}}",
            {"cells"}},
        BadSpecCase{"AlignmentLooserThanConvergence",
                    R"({"controller": {"convergence": {"active_tolerance": 1e-4}}})",
                    {"/controller/convergence/active_tolerance"}},
        BadSpecCase{"MissingCsv",
                    R"({"sampling": {"method": "explicit", "file": "absent.csv"}})",
                    {"/sampling/file", "absent.csv"}},
        BadSpecCase{"CsvWithAMissingColumn",
                    R"({"sampling": {"method": "explicit", "file": "short.csv"}})",
                    {"/sampling/file", "line 3"}},
        BadSpecCase{"CsvWithText",
                    R"({"sampling": {"method": "explicit", "file": "text.csv"}})",
                    {"/sampling/file", "line 3", "heavy"}},
        BadSpecCase{"CsvWithAnUnknownColumn",
                    R"({"sampling": {"method": "explicit", "file": "unknown.csv"}})",
                    {"/sampling/file", "plant.m9"}},
        BadSpecCase{"SeveralMistakes",
                    R"({"horizon": -1, "plant": {"m1": 0, "m3": 1}})",
                    {"/horizon", "/plant/m1", "/plant/m3", "3 mistakes"}},
        BadSpecCase{"DeepNesting", std::string(100000, '['), {"nested too deep"}},
        BadSpecCase{"InvalidUtf8", "{\"name\": \"\xff\"}", {"line 1"}}),
    [](const auto& one) { return one.param.name; });

TEST(BadInput, AMissingSpecExitsWithTwo) {
  const Scratch scratch;
  for (const char* command : {"run", "validate"}) {
    const Ending ending = steerstat({command, scratch / "absent.json"});
    EXPECT_EQ(ending.exit_code, 2);
    EXPECT_THAT(ending.err, HasSubstr("absent.json (No such file or directory)"));
  }
}

TEST(BadInput, ADirectoryForASpecExitsWithTwo) {
  const Scratch scratch;
  const Ending ending = steerstat({"run", scratch / ""});
  EXPECT_EQ(ending.exit_code, 2);
  EXPECT_THAT(ending.err, HasSubstr("Is a directory"));
}

TEST(BadInput, AnEndlessSpecIsRefusedBeforeItFillsTheMemory) {
  const Ending ending = steerstat({"validate", "/dev/zero"});
  EXPECT_EQ(ending.exit_code, 2);
  EXPECT_THAT(ending.err, HasSubstr("larger than a spec may be"));
}

TEST(BadInput, ABadSpecOnStandardInputIsNamedSo) {
  Surroundings surroundings;
  surroundings.input = R"({"horizon": -1})";
  const Ending ending = steerstat({"run", "-"}, surroundings);
  EXPECT_EQ(ending.exit_code, 2);
  EXPECT_THAT(ending.err, HasSubstr("standard input is not a valid study: 1 mistake,"));
  EXPECT_THAT(ending.err, HasSubstr("\n/horizon: "));
}

/// Far more trials than a minute is enough for: a refusal that comes after them would be noticed.
const char* const endless = R"({"plant": {"f2": {"uniform": [0.03, 0.05]}}, "integrator": {"method": "cvode"},
                               "sampling": {"trials": 1000000}})";

TEST(BadInput, AnOutputThatCannotBeWrittenIsFoundBeforeTheFirstTrial) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", endless);
  for (const char* option : {"-o", "--summary"}) {
    for (const std::string& place : {scratch / "absent/out.h5", scratch / ".", spec + "/out.h5"}) {
      const auto start = std::chrono::steady_clock::now();
      const Ending ending = steerstat({"run", spec, option, place});
      EXPECT_EQ(ending.exit_code, 4) << option << ' ' << place;
      EXPECT_THAT(ending.err, HasSubstr(place));
      EXPECT_EQ(ending.out, "");
      EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
      EXPECT_THAT(scratch.names(), ElementsAre("spec.json"));
    }
  }
}

TEST(BadInput, AnOutputWithoutANameIsNotTakenForNoOutput) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", R"({"horizon": 1})");
  for (const char* option : {"-o", "--summary"}) {
    const Ending ending = steerstat({"run", spec, option, ""});
    EXPECT_EQ(ending.exit_code, 4);
    EXPECT_EQ(ending.out, "");
    EXPECT_THAT(ending.err, HasSubstr("without a name"));
  }
}

TEST(BadInput, AFileThatIsNoResultExitsWithFour) {
  const Scratch scratch;
  const std::string text = scratch.file("text.h5", "not HDF5 at all");
  for (const std::string& file : {text, scratch / "absent.h5", scratch / ""}) {
    for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
             {"show", file}, {"replay", file, "--trial", "0"}, {"export", file, "-o", scratch / "out.csv"}}) {
      const Ending ending = steerstat(arguments);
      EXPECT_EQ(ending.exit_code, 4) << arguments.front() << ' ' << file;
      EXPECT_THAT(ending.err, HasSubstr(file));
      EXPECT_EQ(ending.out, "");
    }
  }
  EXPECT_THAT(scratch.names(), ElementsAre("text.h5"));
}

TEST(BadInput, ACutResultFileExitsWithFour) {
  const Scratch scratch;
  const std::string spec = scratch.file("spec.json", R"({"horizon": 1})");
  ASSERT_EQ(steerstat({"run", spec, "-o", scratch / "whole.h5"}).exit_code, 0);
  const std::string whole = read_file(scratch / "whole.h5");
  for (const std::size_t size : {whole.size() - 1, whole.size() / 2, std::size_t{100}, std::size_t{0}}) {
    const Ending ending = steerstat({"show", scratch.file("cut.h5", whole.substr(0, size))});
    EXPECT_EQ(ending.exit_code, 4) << size << " of " << whole.size() << " bytes";
    EXPECT_THAT(ending.err, HasSubstr("cut.h5"));
    EXPECT_EQ(ending.out, "");
  }
}

}  // namespace
}  // namespace steerstat::testing
