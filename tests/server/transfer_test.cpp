// What is streamed, watched and shown, over a real service, asked over sockets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "api/byte_range.hpp"
#include "api/request_metrics.hpp"
#include "api_fixture.hpp"

namespace steerstat::testing {
namespace {

using ::testing::HasSubstr;

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
  std::string stream = client.receive_until("event: done\n");
  stream += client.receive_until("\n\n");
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
  const std::uint64_t last = ids_in(client.receive_until("\ndata:")).back();
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

// What the protocol's clients send: MUQ and the C++ header as text or JSON, Python's requests with Accept and a
// connection that is kept, R and Julia without a type; C++ leaves an empty config out or sends null, R may send an
// empty list.
TEST_F(ApiCase, ModelsAnswerEveryKindOfClient) {
  RawClient client(port);
  for (const std::string fields :
       {"", "Content-Type: text/plain\r\n",
        "Content-Type: application/json\r\nAccept: */*\r\nConnection: keep-alive\r\n",
        "Content-Type: application/x-www-form-urlencoded\r\nAccept: application/json, text/*\r\n"}) {
    for (const std::string config : {"", R"(, "config": {})", R"(, "config": null)", R"(, "config": [])"}) {
      client.send(request("POST", "/InputSizes", fields, R"({"name": "trial")" + config + "}"));
      const RawResponse sizes = client.receive();
      EXPECT_EQ(sizes.status, 200) << fields << config;
      EXPECT_EQ(sizes.body, R"({"inputSizes":[4]})");
      EXPECT_EQ(sizes.field("Content-Length"), std::to_string(sizes.body.size())) << "none of them needs chunks";
    }
  }
  client.send(request("GET", "/Info", "Accept: text/html\r\n"));
  EXPECT_EQ(client.receive().body, R"({"protocolVersion":1.0,"models":["trial","study"]})")
      << "1 is no double everywhere";
}

// All of them look for `error` in whatever is answered, and for nothing else.
TEST_F(ApiCase, ModelsRefuseInTheProtocolsWordsAlsoWhenTheyAreBusyOrAskedForNonsense) {
  const std::string question = R"({"name": "study", "input": [[0.4, 0.7]], "config": {"study": )";
  ApiOptions options;
  options.evaluations = 0;
  reopen(std::move(options));
  const RawResponse busy = post("/Evaluate", question + quick_spec(10) + "}}");
  EXPECT_EQ(busy.status, 503);
  EXPECT_EQ(busy.field("Retry-After"), "5");
  EXPECT_EQ(ordered_json_of(busy.body).at("error").at("type"), "Unavailable") << busy.body;
  reopen({});
  for (const std::string nonsense : {"NaN", "Infinity", "1e999", "[]", "{}"}) {
    const RawResponse refused = post("/Evaluate", R"({"name": "trial", "input": [[0, 0, 0, )" + nonsense + "]]}");
    EXPECT_EQ(refused.status, 400) << nonsense;
    EXPECT_EQ(ordered_json_of(refused.body).at("error").at("type"), "InvalidInput") << refused.body;
  }
  for (const std::string action : {"Gradient", "ApplyJacobian", "ApplyHessian"}) {
    const RawResponse refused =
        post("/" + action, R"({"name": "trial", "outWrt": 0, "inWrt": 0, "input": [[0, 0, 0, 0]]})");
    EXPECT_EQ(refused.status, 400);
    EXPECT_EQ(ordered_json_of(refused.body).at("error").at("type"), "UnsupportedFeature") << refused.body;
  }
  // Newer clients try whether memory can be shared, and do without where nobody answers.
  EXPECT_EQ(post("/TestShMem", R"({"name": "trial", "tid": "1"})").status, 404);
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
