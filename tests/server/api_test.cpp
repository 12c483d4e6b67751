// Studies and trials over a real service, asked over sockets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "api/acceptance.hpp"
#include "api_fixture.hpp"

namespace steerstat::testing {
namespace {

using ::testing::HasSubstr;

TEST_F(ApiCase, AStudyIsCreatedOnceAndFoundAgain) {
  const RawResponse created = post("/v1/studies", quick_spec(50));
  EXPECT_EQ(created.status, 201);
  const Json state = ordered_json_of(created.body);
  EXPECT_EQ(created.field("Location"), "/v1/studies/" + state.at("id").get<std::string>());
  EXPECT_EQ(state.at("progress").at("requested"), 50);
  const RawResponse again = post("/v1/studies", quick_spec(50), "Application/JSON; charset=utf-8");
  EXPECT_EQ(again.status, 200);
  EXPECT_EQ(again.field("Location"), created.field("Location"));
  EXPECT_EQ(ordered_json_of(get("/v1/studies").body).at("studies").size(), 1U);
}

TEST_F(ApiCase, EveryMistakeInASpecIsToldAtItsPlace) {
  const RawResponse response = post("/v1/studies", R"({"plant": {"m1": {"uniform": [1.2, 0.8]}}, "horzon": 3})");
  EXPECT_EQ(response.status, 422);
  EXPECT_EQ(response.field("Content-Type"), "application/problem+json");
  const Json errors = ordered_json_of(response.body).at("errors");
  ASSERT_EQ(errors.size(), 2U) << response.body;
  EXPECT_EQ(errors[0].at("pointer"), "/plant/m1/uniform");
  EXPECT_THAT(errors[1].at("detail").get<std::string>(), HasSubstr("horizon"));
}

TEST_F(ApiCase, BodiesThatAreNotJsonAreRefused) {
  EXPECT_EQ(post("/v1/studies", "{").status, 400);
  EXPECT_EQ(post("/v1/studies", "\xff").status, 400);
  EXPECT_EQ(post("/v1/studies", std::string(100'000, '[')).status, 400);
  EXPECT_EQ(post("/v1/studies", "{}", "text/plain").status, 415);
  EXPECT_EQ(ask(port, request("POST", "/v1/studies", "", "{}")).status, 415);
  EXPECT_EQ(post("/v1/studies", R"({"name": "a", "name": "b"})").status, 422);
  EXPECT_EQ(post("/v1/studies", R"({"sampling": {"method": "explicit", "file": "/etc/passwd"}})").status, 422);
}

TEST_F(ApiCase, WhatIsNotThereIsSaidToBeNotThere) {
  const std::string study = finished();
  for (const std::string target : {"/v1", "/v1/studies/", "/v1/studies/0123456789abcdef", "/v1/studies/..%2fx",
                                   "/v1/studies/ABC", "/v1/schemas/passwd", "//", "/v1/studies/0/0/0/0"}) {
    EXPECT_EQ(get(target).status, 404) << target;
  }
  for (const std::string target :
       {"/trials/50", "/trials/-1", "/trials/x", "/trials/99999999999999999999", "/nothing"}) {
    EXPECT_EQ(get(study + target).status, 404) << target;
  }
}

TEST_F(ApiCase, MethodsThatDoNotApplyAreToldWhichDo) {
  const RawResponse response = ask(port, request("PUT", "/v1/studies"));
  EXPECT_EQ(response.status, 405);
  EXPECT_EQ(response.field("Allow"), "POST, GET, HEAD");
  EXPECT_EQ(ask(port, request("OPTIONS", "/healthz")).status, 405);
}

TEST_F(ApiCase, WhatAClientDoesNotTakeIsNotSent) {
  const std::string study = finished();
  const RawResponse refused = get(study, "Accept: application/xml, text/*\r\n");
  EXPECT_EQ(refused.status, 406);
  EXPECT_EQ(refused.field("Content-Type"), "application/problem+json");
  EXPECT_EQ(get(study, "Accept: text/html\r\nAccept: application/json\r\n").status, 200);
  EXPECT_EQ(get(study + "/results.h5", "Accept: application/json\r\n").status, 406);
  EXPECT_EQ(get("/metrics", "Accept: text/plain;version=0.0.4;q=0.5\r\n").status, 200);
  EXPECT_EQ(get("/Info", "Accept: text/html\r\n").status, 200) << "clients of UM-Bridge say what they like";
}

TEST(Accepts, GoesByTheMostSpecificRange) {
  for (const std::string taken :
       {"", " ", "*/*", "application/*", "Application/JSON", "text/html, */*;q=0.1", "application/json;q=0.001",
        "application/*;q=0, application/json", "a, ,application/json;a=b"}) {
    EXPECT_TRUE(accepts(taken, "application/json")) << taken;
  }
  for (const std::string refused :
       {"text/html", "application/jso", "application/json;q=0", "*/*, application/json;q=0.0", "application/*;q=0, */*",
        "*", "application/", ",", "applicationx/*"}) {
    EXPECT_FALSE(accepts(refused, "application/json")) << refused;
  }
}

TEST(ApiOptions, LeaveWorkersForThoseWhoAreAnsweredAtOnce) {
  const ApiOptions options;
  EXPECT_LE(options.event_streams + options.downloads + options.computations + options.evaluations + options.summaries +
                options.readings + 16,
            DoorLimits{}.workers);
}

TEST_F(ApiCase, QueriesAreCheckedToo) {
  const std::string study = finished();
  for (const std::string query :
       {"?limt=3", "?limit=0", "?limit=1001", "?limit=1&limit=2", "?limit=x", "?cursor=-1", "?status=late", "?cell="}) {
    EXPECT_EQ(get(study + "/trials" + query).status, 400) << query;
  }
  EXPECT_EQ(get("/v1/studies?cursor=nonsense").status, 400);
  EXPECT_EQ(get("/v1/studies?limit=101").status, 400);
  EXPECT_EQ(get(study + "?x=1").status, 400);
}

TEST_F(ApiCase, PagesOfTrialsAreAllOfThemOnce) {
  const std::string study = finished(50);
  std::vector<std::uint64_t> indices;
  std::string cursor = "0";
  while (!cursor.empty()) {
    const Json page = ordered_json_of(get(study + "/trials?limit=20&cursor=" + cursor).body);
    for (const Json& trial : page.at("trials")) indices.push_back(trial.at("index").get<std::uint64_t>());
    cursor = page.at("next").is_null() ? "" : text_of(page.at("next"));
  }
  ASSERT_EQ(indices.size(), 50U);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ(indices[i], i);
}

TEST_F(ApiCase, TrialsAreFilteredByStatus) {
  const std::string study = finished(50);
  const Json outcomes = ordered_json_of(get(study + "/summary").body).at("outcomes");
  for (const auto& [status, count] : outcomes.items()) {
    EXPECT_EQ(ordered_json_of(get(study + "/trials?limit=1000&status=" + status).body).at("trials").size(), count)
        << status;
  }
}

TEST_F(ApiCase, ATrajectoryEndsAsItsTrialDid) {
  const std::string study = finished();
  const Json trial = ordered_json_of(get(study + "/trials/7").body);
  const Json replayed = ordered_json_of(get(study + "/trials/7/trajectory").body);
  EXPECT_EQ(replayed.at("outcome"), trial.at("outcome"));
  EXPECT_EQ(replayed.at("parameters"), trial.at("parameters"));
  EXPECT_EQ(replayed.at("trajectory").at("t").back(), trial.at("outcome").at("end_time"));
}

TEST_F(ApiCase, ATrialThatTakesTooLongToComputeAgainIsNotWaitedFor) {
  service.reset();
  limits.replaying_time = std::chrono::milliseconds(0);
  begin();
  reopen({});
  const std::string study = finished();
  for (const std::string what : {"/trajectory", "/view"}) {
    const RawResponse response = get(study + "/trials/7" + what);
    EXPECT_EQ(response.status, 503) << what;
    EXPECT_FALSE(response.field("Retry-After").empty()) << what;
    EXPECT_THAT(response.body, HasSubstr("takes longer")) << what;
  }
}

TEST_F(ApiCase, WhatAClientHasIsNotSentAgain) {
  const std::string study = finished();
  for (const std::string target :
       {"", "/summary", "/spec", "/trials", "/trials/3", "/trials/3/trajectory", "/results.h5"}) {
    const std::string tag = get(study + target).field("ETag");
    ASSERT_FALSE(tag.empty()) << target;
    EXPECT_EQ(get(study + target, "If-None-Match: \"x\", W/" + tag + "\r\n").status, 304) << target;
    EXPECT_EQ(get(study + target, "If-None-Match: \"x\"\r\n").status, 200) << target;
  }
}

TEST_F(ApiCase, DeleteCancelsThenRemoves) {
  const std::string study = "/v1/studies/" + submit(long_spec());
  const RawResponse cancelled = ask(port, request("DELETE", study));
  EXPECT_EQ(cancelled.status, 200);
  EXPECT_EQ(ordered_json_of(cancelled.body).at("status"), "cancelled");
  wait_for_end(study.substr(12));
  EXPECT_EQ(ask(port, request("DELETE", study)).status, 204);
  EXPECT_EQ(ask(port, request("DELETE", study)).status, 404);
}

TEST_F(ApiCase, AStudyComparesWithItself) {
  const std::string id = finished().substr(12);
  const RawResponse response = post("/v1/comparisons", R"({"a": ")" + id + R"(", "b": ")" + id + R"("})");
  EXPECT_EQ(response.status, 200) << response.body;
  EXPECT_EQ(ordered_json_of(response.body).at("a").at("id"), id);
}

TEST_F(ApiCase, WhatCannotBeComparedIsToldWhy) {
  const std::string a = finished(50).substr(12);
  const std::string b = submit(quick_spec(50, 2));
  wait_for_end(b);
  const RawResponse other_seed = post("/v1/comparisons", R"({"a": ")" + a + R"(", "b": ")" + b + R"("})");
  EXPECT_EQ(other_seed.status, 422);
  EXPECT_THAT(other_seed.body, HasSubstr("seed"));
  const Json errors = ordered_json_of(post("/v1/comparisons", R"({"a": "none", "c": 1})").body).at("errors");
  ASSERT_EQ(errors.size(), 3U) << text_of(errors);
  EXPECT_EQ(errors[0].at("pointer"), "/a");
  EXPECT_EQ(errors[2].at("pointer"), "/c");
}

}  // namespace
}  // namespace steerstat::testing
