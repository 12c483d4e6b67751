#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "process.hpp"

namespace steerstat::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string paper_specs = STEERSTAT_SOURCE_DIR "/studies/specs/paper/";

TEST(PaperTable, TheShippedSpecsGiveTheDefinitionsFigures) {
  const Ending table = Process(PAPER_TABLE_PROGRAM, {}).wait();
  EXPECT_EQ(table.exit_code, 0) << table.out << table.err;
  EXPECT_THAT(table.out, HasSubstr("contraction cycles"));
  EXPECT_THAT(table.out, Not(HasSubstr("OUTSIDE")));
}

TEST(PaperTable, AnotherExperimentIsNoticed) {
  const Scratch scratch;
  scratch.file("nominal.json", read_file(paper_specs + "friction.json"));
  scratch.file("friction.json", read_file(paper_specs + "friction.json"));
  const Ending table = Process(PAPER_TABLE_PROGRAM, {scratch / ""}).wait();
  EXPECT_EQ(table.exit_code, 1);
  EXPECT_THAT(table.out, HasSubstr("OUTSIDE THE TOLERANCE"));
}

TEST(PaperTable, MissingSpecsExitWithTwo) {
  const Scratch scratch;
  EXPECT_EQ(Process(PAPER_TABLE_PROGRAM, {scratch / ""}).wait().exit_code, 2);
}

}  // namespace
}  // namespace steerstat::testing
