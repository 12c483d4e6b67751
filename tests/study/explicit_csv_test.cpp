#include "study/explicit_csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "core/errors.hpp"
#include "study/limits.hpp"
#include "study/spec_json.hpp"

namespace steerstat {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

ExplicitTable parse(std::string_view text) {
  std::vector<std::string> problems;
  ExplicitTable table = parse_explicit_csv(text, problems);
  EXPECT_THAT(problems, IsEmpty());
  return table;
}

std::vector<std::string> problems_of(std::string_view text) {
  std::vector<std::string> problems;
  parse_explicit_csv(text, problems);
  return problems;
}

TEST(ExplicitCsv, ReadsAHeaderAndALineOfNumbersATrial) {
  const ExplicitTable table = parse("plant.m1,initial_state.q2\n1.1,-0.3\n1.2,4e-1\n");
  EXPECT_THAT(table.names, ElementsAre("plant.m1", "initial_state.q2"));
  EXPECT_THAT(table.values, ElementsAre(1.1, -0.3, 1.2, 0.4));
  EXPECT_EQ(table.rows(), 2U);
}

TEST(ExplicitCsv, AllowsSpacesQuotesCrlfByteOrderMarkEmptyLinesAndNoLastNewline) {
  const ExplicitTable table = parse("\xEF\xBB\xBF\"plant.m1\" , plant.m2\r\n\r\n 1 ,\t+2\r\n\n\"3\",4");
  EXPECT_THAT(table.names, ElementsAre("plant.m1", "plant.m2"));
  EXPECT_THAT(table.values, ElementsAre(1.0, 2.0, 3.0, 4.0));
}

TEST(ExplicitCsv, NamesTheLineAndColumnOfTextInNumbers) {
  EXPECT_THAT(problems_of("plant.m1,plant.m2\n1,2\n1,heavy\n"),
              ElementsAre("line 3: column plant.m2: \"heavy\" is not a finite number; correct it"));
  EXPECT_THAT(problems_of("plant.m1,plant.m2\n1,\n"),
              ElementsAre("line 2: column plant.m2: \"\" is not a finite number; correct it"));
}

TEST(ExplicitCsv, RefusesWhatIsAlmostANumber) {
  for (const char* const field :
       {"nan", "inf", "-inf", "1e999", "0x10", "1 2", "1,5,", "--1", "+-1", "1.0f", "1_000"}) {
    EXPECT_THAT(problems_of("initial_state.q1\n" + std::string(field) + "\n"), SizeIs(1)) << field;
  }
}

TEST(ExplicitCsv, RefusesMissingAndSpareFields) {
  EXPECT_THAT(problems_of("plant.m1,plant.m2\n1\n1,2,3\n"),
              ElementsAre("line 2: 1 fields (the header has 2); every line needs a number for each column",
                          "line 3: 3 fields (the header has 2); every line needs a number for each column"));
}

TEST(ExplicitCsv, RefusesUnknownAndRepeatedColumns) {
  EXPECT_THAT(problems_of("plant.M1,plant.m2,plant.m2,colour\n1,1,1,1\n"),
              ElementsAre("line 1: unknown column \"plant.M1\" (columns are called like plant.m1); did you mean "
                          "\"plant.m1\"?",
                          "line 1: the column plant.m2 appears twice (once each); remove one",
                          "line 1: unknown column \"colour\" (columns are called like plant.m1); remove or rename it"));
}

TEST(ExplicitCsv, RefusesValuesOutOfRange) {
  EXPECT_THAT(problems_of("plant.m1\n1\n0\n"),
              ElementsAre("line 3: column plant.m1: 0 is out of range (plant.m1 > 0); give a number > 0"));
}

TEST(ExplicitCsv, RefusesAFileWithoutHeaderOrTrials) {
  EXPECT_THAT(problems_of(""), ElementsAre(HasSubstr("the file is empty")));
  EXPECT_THAT(problems_of("\n \n"), ElementsAre(HasSubstr("the file is empty")));
  EXPECT_THAT(problems_of("plant.m1\n"), ElementsAre(HasSubstr("no trials")));
}

TEST(ExplicitCsv, ReportsTwentyProblemsAndCountsTheRest) {
  std::string text = "plant.m1\n";
  for (int i = 0; i < 25; ++i) text += "x\n";
  const auto problems = problems_of(text);
  ASSERT_THAT(problems, SizeIs(21));
  EXPECT_EQ(problems.back(), "and 5 more mistakes");
}

TEST(ExplicitCsv, TakesTheMostTrialsAndNotOneMore) {
  std::string text = "plant.m1\n";
  for (std::size_t i = 0; i < most_explicit_trials; ++i) text += "1\n";
  EXPECT_EQ(parse(text).rows(), most_explicit_trials);
  EXPECT_THAT(problems_of(text + "\n1\n"), ElementsAre(HasSubstr("too many trials (at most 100000)")));
}

// A directory of its own for files, removed afterwards.
class ExplicitFile : public ::testing::Test {
 protected:
  ExplicitFile() { std::filesystem::create_directories(directory_); }
  ~ExplicitFile() override { std::filesystem::remove_all(directory_); }
  ExplicitFile(const ExplicitFile&) = delete;
  ExplicitFile& operator=(const ExplicitFile&) = delete;

  void write(const std::string& name, std::string_view text) const {
    std::ofstream(directory_ / name, std::ios::binary) << text;
  }

  [[nodiscard]] Study decode(const std::string& name) const {
    return decode_study(R"({"sampling": {"method": "explicit", "file": ")" + name + "\"}}", directory_);
  }

  [[nodiscard]] std::string error_of(const std::string& name) const {
    try {
      (void)decode(name);
    } catch (const BadSpec& bad) {
      return bad.what();
    }
    return "accepted";
  }

  std::filesystem::path directory_ =
      std::filesystem::temp_directory_path() /
      ("steerstat-explicit-" + std::to_string(std::chrono::steady_clock::now().time_since_epoch().count()));
};

TEST_F(ExplicitFile, IsTheSameStudyAsItsTrialsInline) {
  write("x.csv", "initial_state.q2,plant.m1\n0.3,1.1\n0.4,1.2\n");
  const Study from_file = decode("x.csv");
  const Study inlined = decode_study(R"({"sampling": {"method": "explicit", "trials":
      [{"plant.m1": 1.1, "initial_state.q2": 0.3}, {"initial_state.q2": 0.4, "plant.m1": 1.2}]}})",
                                     {});
  EXPECT_EQ(from_file, inlined);
  EXPECT_EQ(canonical_spec(from_file), canonical_spec(inlined));
  EXPECT_EQ(decode_study(canonical_spec(from_file), {}), from_file);
}

TEST_F(ExplicitFile, SaysWhenItIsMissingOrNoFile) {
  EXPECT_EQ(error_of("y.csv"),
            "/sampling/file: \"y.csv\" cannot be read: there is no such file; names are relative to the spec");
  EXPECT_EQ(error_of("."),
            "/sampling/file: \".\" cannot be read: it is not a regular file; names are relative to the spec");
  EXPECT_EQ(error_of(""), "/sampling/file: not a file's name; give the name of a CSV file");
}

TEST_F(ExplicitFile, ReportsEveryLineThatIsWrong) {
  write("bad.csv", "plant.m1,plant.m2\n1,x\n1\n");
  EXPECT_EQ(error_of("bad.csv"),
            "/sampling/file: \"bad.csv\": line 2: column plant.m2: \"x\" is not a finite number; correct it\n"
            "/sampling/file: \"bad.csv\": line 3: 1 fields (the header has 2); every line needs a number for each "
            "column");
}

TEST_F(ExplicitFile, IsRefusedWhenEmpty) {
  write("empty.csv", "");
  EXPECT_THAT(error_of("empty.csv"), HasSubstr("the file is empty"));
}

TEST_F(ExplicitFile, IsCheckedAgainstTheRestOfTheSpec) {
  write("cross.csv", "controller.alignment.tolerance\n0.001\n0.03\n");
  EXPECT_THAT(error_of("cross.csv"), HasSubstr("in trial 1 the active error would have to be within 0.02"));
}

}  // namespace
}  // namespace steerstat
