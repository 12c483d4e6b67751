// The API on a real service, asked over sockets.
#include "api/api.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "../service/service_fixture.hpp"
#include "api/byte_range.hpp"
#include "api/request_metrics.hpp"
#include "json_text.hpp"
#include "open_server.hpp"
#include "raw_client.hpp"

namespace steerstat::testing {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class ApiCase : public ServiceCase {
 protected:
  ApiCase() { reopen({}); }
  ~ApiCase() override {
    if (api) api->stop();
    server.reset();
  }

  void reopen(ApiOptions options) {
    if (api) api->stop();
    server.reset();
    api = std::make_unique<Api>(*service, std::move(options));
    server = std::make_unique<OpenServer>(
        at_free_port(), [this](const auto& question, auto& answer) { api->answer(question, answer); });
    port = server->port();
  }

  RawResponse get(const std::string& target, const std::string& fields = "") const {
    return ask(port, request("GET", target, fields));
  }
  RawResponse post(const std::string& target, const std::string& body,
                   const std::string& type = "application/json") const {
    return ask(port, request("POST", target, "Content-Type: " + type + "\r\n", body));
  }
  /// Submits a spec. @return its id
  std::string submit(const std::string& spec) const {
    return ordered_json_of(post("/v1/studies", spec).body).at("id").get<std::string>();
  }
  /// Submits a quick study and waits for its end. @return where it is
  std::string finished(std::uint64_t trials = 50) {
    const std::string id = submit(quick_spec(trials));
    wait_for_end(id);
    return "/v1/studies/" + id;
  }

  std::unique_ptr<Api> api;
  std::unique_ptr<OpenServer> server;
  std::uint16_t port{0};
};

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

TEST_F(ApiCase, TheResultFileComesWholeOrInPart) {
  const std::string study = finished();
  const RawResponse whole = get(study + "/results.h5");
  EXPECT_EQ(whole.status, 200);
  EXPECT_EQ(whole.body, read_file(*service->result_file(study.substr(12))));
  const RawResponse part = get(study + "/results.h5", "Range: bytes=5-14\r\nIf-Range: " + whole.field("ETag") + "\r\n");
  EXPECT_EQ(part.status, 206);
  EXPECT_EQ(part.body, whole.body.substr(5, 10));
  EXPECT_EQ(part.field("Content-Range"), "bytes 5-14/" + std::to_string(whole.body.size()));
  EXPECT_EQ(get(study + "/results.h5", "Range: bytes=5-14\r\nIf-Range: \"old\"\r\n").status, 200);
  EXPECT_EQ(get(study + "/results.h5", "Range: bytes=0-1,5-6\r\n").body.size(), whole.body.size());
  EXPECT_EQ(get(study + "/results.h5", "Range: bytes=99999999-\r\n").status, 416);
}

TEST_F(ApiCase, AStudyUnderWayHasNoResultFileYet) {
  const std::string study = "/v1/studies/" + submit(long_spec());
  const RawResponse response = get(study + "/results.h5");
  EXPECT_EQ(response.status, 409);
  EXPECT_FALSE(response.field("Retry-After").empty());
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

/// The ids of a stream's events, in order.
std::vector<std::uint64_t> ids_in(const std::string& stream) {
  std::vector<std::uint64_t> ids;
  for (std::size_t at = stream.find("id: "); at != std::string::npos; at = stream.find("id: ", at + 1)) {
    ids.push_back(std::stoull(stream.substr(at + 4)));
  }
  return ids;
}

TEST_F(ApiCase, EventsTellOfProgressAndThenOfTheEnd) {
  const std::string id = submit(quick_spec(20'000));
  RawClient client(port);
  client.send(request("GET", "/v1/studies/" + id + "/events"));
  const std::string stream = client.receive_until("event: done\n") + client.receive_until("\n\n");
  EXPECT_THAT(stream, HasSubstr("Content-Type: text/event-stream"));
  EXPECT_TRUE(client.is_closed());
  const std::vector<std::uint64_t> ids = ids_in(stream);
  EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end()));
  const std::string last = stream.substr(stream.rfind("data: ") + 6);
  EXPECT_EQ(ordered_json_of(last).at("status"), "succeeded");
}

TEST_F(ApiCase, WhoHasSeenTheEndIsToldThatNothingComes) {
  const std::string study = finished();
  RawClient client(port);
  client.send(request("GET", study + "/events"));
  const std::uint64_t last = ids_in(client.receive_until("\n\n") + client.receive_until("\ndata:")).back();
  EXPECT_EQ(get(study + "/events", "Last-Event-ID: " + std::to_string(last) + "\r\n").status, 204);
}

TEST_F(ApiCase, StreamsOfEventsHaveAShareOfTheWorkers) {
  ApiOptions options;
  options.event_streams = 1;
  reopen(std::move(options));
  const std::string study = "/v1/studies/" + submit(long_spec());
  {
    RawClient client(port);
    client.send(request("GET", study + "/events"));
    EXPECT_THAT(client.receive_until("event: progress"), HasSubstr("event: progress"));
    const RawResponse second = get(study + "/events");
    EXPECT_EQ(second.status, 503);
    EXPECT_FALSE(second.field("Retry-After").empty());
  }
  // Once the client has gone, its place is free.
  RawResponse response;
  for (int i = 0; i < 100 && response.status != 200; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    RawClient client(port);
    client.send(request("GET", study + "/events"));
    response = client.receive();
  }
  EXPECT_EQ(response.status, 200);
}

TEST_F(ApiCase, AFullQueueSaysWhenToComeAgain) {
  service.reset();
  limits.queued_studies = 1;
  limits.running_studies = 1;
  limits.places_for_small = 0;
  begin();
  reopen({});
  RawResponse response;
  for (std::uint64_t seed = 1; seed <= 4 && response.status != 503; ++seed) {
    response = post("/v1/studies", long_spec(seed));
  }
  EXPECT_EQ(response.status, 503);
  EXPECT_FALSE(response.field("Retry-After").empty());
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

TEST_F(ApiCase, SchemasAreServedAsTheyAreInTheTree) {
  const std::string text = read_file(std::string(STEERSTAT_SOURCE_DIR) + "/schemas/study.schema.json");
  EXPECT_EQ(get("/v1/schemas/study").body, text);
  EXPECT_EQ(get("/v1/schemas/study.schema.json").body, text);
  EXPECT_EQ(ordered_json_of(get("/openapi.json").body).at("openapi"), "3.1.0");
}

TEST_F(ApiCase, MetricsCountTrialsAndRequests) {
  ApiOptions options;
  options.door = [this] { return server->counters(); };
  reopen(std::move(options));
  finished(50);
  get("/v1/nothing");
  ask(port, "GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n");
  const std::string text = get("/metrics").body;
  EXPECT_THAT(text, HasSubstr("\nsteerstat_trials_done_total 50\n"));
  EXPECT_THAT(text, HasSubstr("\nsteerstat_studies{status=\"succeeded\"} 1\n"));
  EXPECT_THAT(text,
              HasSubstr("\nsteerstat_http_requests_total{route=\"/v1/studies\",method=\"POST\",code=\"201\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("\nsteerstat_http_requests_total{route=\"none\",method=\"any\",code=\"404\"} 1\n"));
  EXPECT_THAT(text,
              HasSubstr("\nsteerstat_http_request_duration_seconds_bucket{route=\"/v1/studies\",le=\"+Inf\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("\nsteerstat_http_refused_total{code=\"421\"} 1\n"));
}

TEST_F(ApiCase, TheFrontPageRunsNoScriptButItsOwn) {
  const RawResponse plain = get("/");
  EXPECT_EQ(plain.status, 200);
  EXPECT_THAT(plain.body, HasSubstr("openapi.json"));
  EXPECT_THAT(plain.field("Content-Security-Policy"), HasSubstr("default-src 'none'; script-src 'self';"));
  ApiOptions options;
  options.assets = {{"/", "text/html", "<p>front"}, {"/page.js", "text/javascript", "1;"}};
  reopen(std::move(options));
  EXPECT_EQ(get("/").body, "<p>front");
  EXPECT_EQ(get("/page.js").field("Content-Type"), "text/javascript");
  EXPECT_EQ(get("/healthz").field("Content-Security-Policy"), "default-src 'none'; frame-ancestors 'none'");
}

TEST_F(ApiCase, ModelsAnswerWithoutAContentType) {
  EXPECT_EQ(ordered_json_of(get("/Info").body).at("protocolVersion"), 1.0);
  const RawResponse sizes = ask(port, request("POST", "/InputSizes", "", R"({"name": "trial", "config": {}})"));
  EXPECT_EQ(sizes.status, 200);
  EXPECT_EQ(text_of(ordered_json_of(sizes.body)), R"({"inputSizes":[4]})");
  const std::string question = R"({"name": "trial", "input": [[0, 0, 0, 0]], "config": {}})";
  const RawResponse nominal = ask(port, request("POST", "/Evaluate", "", question));
  EXPECT_EQ(ordered_json_of(nominal.body).at("output")[0][0], 1) << nominal.body;
  const RawResponse missing = ask(port, request("POST", "/Evaluate", "", R"({"name": "x", "input": [[0]]})"));
  EXPECT_EQ(missing.status, 400);
  EXPECT_EQ(ordered_json_of(missing.body).at("error").at("type"), "ModelNotFound");
}

TEST(SingleRange, IsOneOrNone) {
  EXPECT_EQ(single_range("bytes=0-0", 10), (ByteRange{0, 1}));
  EXPECT_EQ(single_range("bytes=9-", 10), (ByteRange{9, 1}));
  EXPECT_EQ(single_range("bytes=3-99", 10), (ByteRange{3, 7}));
  EXPECT_EQ(single_range("bytes=-4", 10), (ByteRange{6, 4}));
  EXPECT_EQ(single_range("bytes=-99", 10), (ByteRange{0, 10}));
  for (const std::string none : {"bytes=10-", "bytes=-0", "bytes=11-12"})
    EXPECT_EQ(single_range(none, 10)->size, 0U) << none;
  for (const std::string other :
       {"bytes=0-1,3-4", "bytes=5-4", "bytes=-", "bytes=", "lines=0-1", "bytes=a-b", "", "bytes=1-2-3"}) {
    EXPECT_FALSE(single_range(other, 10)) << other;
  }
}

TEST(RequestMetrics, BucketsCountAllThatTookNoLonger) {
  RequestMetrics metrics;
  metrics.observe("/a", "GET", 200, 0.001);
  metrics.observe("/a", "GET", 200, 0.0011);
  metrics.observe("/a", "GET", 200, 99.0);
  const std::string text = metrics.text();
  EXPECT_THAT(text, HasSubstr("_bucket{route=\"/a\",le=\"0.001\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("_bucket{route=\"/a\",le=\"0.0025\"} 2\n"));
  EXPECT_THAT(text, HasSubstr("_bucket{route=\"/a\",le=\"10\"} 2\n"));
  EXPECT_THAT(text, HasSubstr("_bucket{route=\"/a\",le=\"+Inf\"} 3\n"));
  EXPECT_THAT(text, HasSubstr("_count{route=\"/a\"} 3\n"));
}

}  // namespace
}  // namespace steerstat::testing
