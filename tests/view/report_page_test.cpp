#include "page/report_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "core/errors.hpp"

namespace steerstat {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::string_view html = R"(<!doctype html>
<html lang="en">
  <head>
    <meta charset="utf-8">
    <title>steerstat</title>
    <link rel="stylesheet" href="page.css">
  </head>
  <body>
    <div id="page"></div>
    <script src="page.js"></script>
  </body>
</html>
)";

const PageFiles page{html, "body{margin:0}", "draw()", ""};

/// What stands between the first `begin` and the next `end`.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin) + begin.size();
  return text.substr(from, text.find(end, from) - from);
}

TEST(ContentHash, IsSha256InBase64) {
  // printf abc | openssl dgst -sha256 -binary | base64
  EXPECT_EQ(content_hash("abc"), "sha256-ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0=");
  EXPECT_EQ(content_hash(""), "sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU=");
}

TEST(ReportPage, AllowsItsOwnScriptAndStyleAndNothingElse) {
  const std::string report = report_page(page, "title", "{}");
  const std::string policy = between(report, "Content-Security-Policy\" content=\"", "\"");
  EXPECT_THAT(policy, HasSubstr("default-src 'none'"));
  EXPECT_THAT(policy, HasSubstr("script-src '" + content_hash(between(report, "<script>", "</script>")) + "'"));
  EXPECT_THAT(policy, HasSubstr("style-src '" + content_hash(between(report, "<style>", "</style>")) + "'"));
  EXPECT_THAT(policy, Not(HasSubstr("unsafe")));
  EXPECT_LT(report.find("Content-Security-Policy"), report.find("<style>"));
}

TEST(ReportPage, RefersToNoOtherFile) {
  const std::string report = report_page(page, "title", "{}");
  EXPECT_THAT(report, Not(HasSubstr("src=")));
  EXPECT_THAT(report, Not(HasSubstr("href=")));
}

TEST(ReportPage, HoldsTheDocumentSoThatNoStringInItEndsItsElement) {
  const std::string document = R"({"name": "</script><script>alert(1)</script><!--", "of": 3})";
  const std::string report = report_page(page, "title", document);
  const std::string held = between(report, "id=\"steerstat-report\">", "</script>");
  EXPECT_EQ(held, R"({"name": "\u003c/script>\u003cscript>alert(1)\u003c/script>\u003c!--", "of": 3})");
  EXPECT_LT(report.find("steerstat-report"), report.find("<script>draw()"));
}

TEST(ReportPage, HasTheTitleAsText) {
  const std::string report = report_page(page, "<title>steerstat</title> & \"more\"", "{}");
  EXPECT_THAT(report, HasSubstr("<title>&lt;title>steerstat&lt;/title> &amp; \"more\" · steerstat</title>"));
}

TEST(ReportPage, RefusesAProgramWithoutThePageAndSaysWhatToDo) {
  const PageFiles absent{"", "", "", "there was no npm where it was built"};
  try {
    report_page(absent, "title", "{}");
    FAIL() << "it made a page of nothing";
  } catch (const RunFailure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("there was no npm where it was built"));
    EXPECT_THAT(failure.what(), HasSubstr("-DSTEERSTAT_PAGE=ON"));
  }
}

TEST(ReportPage, NoticesAPageThatIsLaidOutOtherwise) {
  const PageFiles other{"<html></html>", "", "draw()", ""};
  EXPECT_THROW(report_page(other, "title", "{}"), std::logic_error);
}

TEST(EmbeddedPage, IsWholeOrSaysWhyItIsNotThere) {
  const PageFiles embedded = embedded_page();
  if (embedded.absence.empty()) {
    EXPECT_FALSE(embedded.script.empty());
    EXPECT_LT(embedded.script.size(), 400'000U);
    EXPECT_THAT(report_page(embedded, "title", "{}"), HasSubstr("steerstat-report"));
  } else {
    EXPECT_TRUE(embedded.html.empty() && embedded.script.empty() && embedded.style.empty());
  }
}

}  // namespace
}  // namespace steerstat
