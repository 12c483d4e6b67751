#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <utility>

#include "json_text.hpp"
#include "page/embedded_page.hpp"
#include "process.hpp"

namespace steerstat::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// The document inside a report.
json document_in(const std::string& page) {
  const std::string mark = R"(<script type="application/json" id="steerstat-report">)";
  const std::size_t from = page.find(mark) + mark.size();
  return json_of(page.substr(from, page.find("</script>", from) - from));
}

/// Checks what a program without the page does. @return whether this is one
bool lacks_the_page(const Scratch& scratch) {
  const std::string absence(embedded_page().absence);
  if (absence.empty()) return false;
  const Ending ending = steerstat({"report", scratch / "r.h5", "-o", scratch / "r.html"});
  EXPECT_EQ(ending.exit_code, 4);
  EXPECT_THAT(ending.err, HasSubstr(absence));
  EXPECT_THAT(ending.err, HasSubstr("npm"));
  EXPECT_FALSE(std::filesystem::exists(scratch / "r.html"));
  return true;
}

TEST(Report, HoldsTheStudyAndTrialsThatCanBeOpenedOrSaysThatTheProgramHasNoPage) {
  const Scratch scratch;
  if (lacks_the_page(scratch)) return;
  const std::string spec = scratch.file("spec.json", R"({"name": "a < b & c", "plant": {"f2": {"uniform": [0, 0.04]}},
      "horizon": 200, "audit": {"trials": 0}, "sampling": {"trials": 200}})");
  ASSERT_EQ(steerstat({"run", spec, "-o", scratch / "r.h5", "--no-progress"}).exit_code, 0);
  const Ending written = steerstat({"report", scratch / "r.h5", "-o", scratch / "r.html"});
  ASSERT_EQ(written.exit_code, 0) << written.err;
  EXPECT_EQ(written.out, "");
  const std::string page = read_file(scratch / "r.html");
  EXPECT_LT(page.size(), 5'000'000U);
  const json report = document_in(page);
  EXPECT_EQ(report["file"], "r.h5");
  EXPECT_EQ(report["study"]["summary"]["study"]["name"], "a < b & c");
  EXPECT_EQ(report["study"]["sample"]["index"].size(), 200U);
  ASSERT_GT(report["trials"].size(), 10U);
  EXPECT_LE(report["trials"].size(), 60U);
  EXPECT_NE(report["trials"][0]["outcome"]["status"], "converged");
  EXPECT_EQ(report["trials"].back()["outcome"]["status"], "converged");
  EXPECT_THAT(written.err, HasSubstr("wrote the report on 200 trials"));
}

TEST(Report, LeavesOutWhatWouldCountTrialsThatAreNotAsTheyCome) {
  const Scratch scratch;
  if (lacks_the_page(scratch)) return;
  const std::string common = R"("plant": {"f2": {"uniform": [0, 0.04]}}, "horizon": 100, "audit": {"trials": 0})";
  for (const auto& [rows, rest] :
       {std::pair("sought", R"("sampling": {"method": "importance", "trials": 100, "proposal":
           {"components": [{"inputs": {"plant.f2": {"shift": 1}}}]}})"),
        std::pair("sought", R"("sampling": {"method": "subset_simulation", "trials": 100})"),
        std::pair("failed", R"("sampling": {"trials": 100}, "store": "failed")"),
        std::pair("none", R"("sampling": {"trials": 100}, "store": "summary")")}) {
    const std::string spec = scratch.file("spec.json", "{" + common + ", " + rest + "}");
    const std::string result = scratch / (std::string(rows) + std::to_string(std::string(rest).size()) + ".h5");
    ASSERT_EQ(steerstat({"run", spec, "-o", result, "--no-progress"}).exit_code, 0) << rest;
    const Ending written = steerstat({"report", result, "-o", scratch / "r.html"});
    ASSERT_EQ(written.exit_code, 0) << written.err;
    const json report = document_in(read_file(scratch / "r.html"));
    const json& study = report["study"];
    EXPECT_EQ(study["rows"], rows);
    EXPECT_TRUE(study["marginals"].empty() && study["maps"].empty() && study["distributions"].empty());
    EXPECT_EQ(study["sensitivity"], nullptr);
    EXPECT_EQ(report["trials"].empty(), std::string(rows) == "none") << rest;
  }
}

TEST(Report, RefusesToOverwriteTheResultFile) {
  const Scratch scratch;
  if (lacks_the_page(scratch)) return;
  const std::string spec = scratch.file("spec.json", R"({"horizon": 5, "audit": {"trials": 0}})");
  ASSERT_EQ(steerstat({"run", spec, "-o", scratch / "r.h5", "--no-progress"}).exit_code, 0);
  EXPECT_EQ(steerstat({"report", scratch / "r.h5", "-o", scratch / "r.h5"}).exit_code, 2);
}

}  // namespace
}  // namespace steerstat::testing
