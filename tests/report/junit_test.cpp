#include "report/junit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sample_summary.hpp"

namespace steerstat {
namespace {

using namespace testing_report;
using ::testing::HasSubstr;
using ::testing::Not;

// That it is XML, tests/contract asks of Python's xml.etree.

GateVerdict gate(const char* expr, Verdict verdict) {
  return {"success_rate", expr, {}, 0.5, {0.4, 0.6}, verdict, "all of \"it\" & <more>"};
}

TEST(JunitXml, HasATestCaseAGateAndCountsThem) {
  Summary summary = made_up_summary({5, 5, 0, 0, 0});
  summary.gates = {gate("ci_low > 0.3", Verdict::pass), gate("ci_low > 0.7", Verdict::fail),
                   gate("ci_low > 0.5", Verdict::inconclusive), gate("ci_low > 0.6", Verdict::inconclusive)};
  const std::string xml = junit_xml(summary);
  EXPECT_THAT(xml, HasSubstr("<testsuite name=\"sample\" tests=\"4\" failures=\"1\" errors=\"2\" skipped=\"0\""));
  EXPECT_THAT(xml, HasSubstr("<testcase classname=\"sample\" name=\"success_rate ci_low &#62; 0.3\" time=\"0\"/>"));
  EXPECT_THAT(xml, HasSubstr("<failure type=\"fail\" message=\"all of &#34;it&#34; &#38; &#60;more&#62;\"/>"));
  EXPECT_THAT(xml, HasSubstr("<error type=\"inconclusive\""));
}

TEST(JunitXml, OfAStudyWithoutGatesHasNoTestCase) {
  const std::string xml = junit_xml(made_up_summary({5, 5, 0, 0, 0}));
  EXPECT_THAT(xml, HasSubstr("tests=\"0\""));
  EXPECT_THAT(xml, Not(HasSubstr("<testcase")));
}

TEST(JunitXml, ReplacesWhatXmlDoesNotHave) {
  Summary summary = made_up_summary({5, 5, 0, 0, 0});
  const auto name_of_suite = [&](std::string name) {
    summary.name = std::move(name);
    const std::string xml = junit_xml(summary);
    const std::size_t begin = xml.find("<testsuite name=\"") + 17;
    return xml.substr(begin, xml.find('"', begin) - begin);
  };
  const std::string replaced = "\uFFFD";
  EXPECT_EQ(name_of_suite("a\x01z"), "a" + replaced + "z");
  EXPECT_EQ(name_of_suite(std::string("a\0z", 3)), "a" + replaced + "z");
  EXPECT_EQ(name_of_suite("a\tb\nc\rd"), "a&#9;b&#10;c&#13;d");
  EXPECT_EQ(name_of_suite("\uFFFE\uFFFF\uFFFD"), replaced + replaced + replaced);
  EXPECT_EQ(name_of_suite("\x80"
                          "a\xC3"),
            replaced + "a" + replaced)
      << "not UTF-8";
  EXPECT_EQ(name_of_suite("\xC0\x80"), replaced + replaced) << "overlong";
  EXPECT_EQ(name_of_suite("\xED\xA0\x80"), replaced + replaced + replaced) << "a surrogate";
  EXPECT_EQ(name_of_suite("\xF4\x90\x80\x80"), replaced + replaced + replaced + replaced) << "beyond Unicode";
  EXPECT_EQ(name_of_suite("é 机器人 🤖"), "é 机器人 🤖");
  EXPECT_EQ(name_of_suite("<&>\"'"), "&#60;&#38;&#62;&#34;&#39;");
}

}  // namespace
}  // namespace steerstat
