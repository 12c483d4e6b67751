// Attacks on the door, each of which cpp-httplib 0.11.4 by itself lets through, and what comes of them here.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/errors.hpp"
#include "open_server.hpp"
#include "raw_client.hpp"

namespace steerstat::testing {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// Tells what it was asked, in plain text.
void echo(const httplib::Request& request, httplib::Response& response) {
  if (request.path == "/throw") throw std::runtime_error("a secret");
  if (request.path == "/throw/anything") throw 5;
  if (request.path == "/refuse") throw Refused({503, "as asked", {{"/a", "wrong"}}, {{"Retry-After", "7"}}});
  if (request.path == "/large") {
    response.set_content(std::string(std::size_t{16} << 20U, 'x'), "text/plain");
    return;
  }
  response.set_content(request.method + " " + request.path + " [" + request.body + "]", "text/plain");
}

DoorLimits hasty() {
  DoorLimits limits;
  limits.head_time = 300ms;
  limits.body_time = 300ms;
  limits.idle_time = 600ms;
  limits.write_time = 300ms;
  limits.linger_time = 300ms;
  return limits;
}

class Door : public ::testing::Test {
 protected:
  OpenServer server_{at_free_port(), echo};
  std::uint16_t port_{server_.port()};
};

TEST_F(Door, AnswersSeveralRequestsOnAConnection) {
  RawClient client(port_);
  for (int i = 0; i < 3; ++i) {
    client.send(request("POST", "/a", "", "body " + std::to_string(i)));
    EXPECT_EQ(client.receive().body, "POST /a [body " + std::to_string(i) + "]");
  }
  client.send(request("GET", "/b", "Connection: close\r\n"));
  EXPECT_EQ(client.receive().body, "GET /b []");
  EXPECT_TRUE(client.is_closed());
}

TEST_F(Door, AnswersRequestsThatCameTogetherInTheirOrder) {
  RawClient client(port_);
  client.send(request("POST", "/a", "", "one") + request("GET", "/b") + request("POST", "/c", "", "three"));
  EXPECT_EQ(client.receive().body, "POST /a [one]");
  EXPECT_EQ(client.receive().body, "GET /b []");
  EXPECT_EQ(client.receive().body, "POST /c [three]");
}

TEST_F(Door, HeadRequestsGetNoBody) {
  const RawResponse response = ask(port_, request("HEAD", "/a", "Connection: close\r\n"));
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(response.field("Content-Length"), "10");
}

TEST_F(Door, WhatIsThrownNeverShows) {
  for (const std::string path : {"/throw", "/throw/anything"}) {
    const RawResponse response = ask(port_, request("GET", path));
    EXPECT_EQ(response.status, 500);
    EXPECT_EQ(response.field("Content-Type"), "application/problem+json");
    EXPECT_EQ((response.head + response.body).find("secret"), std::string::npos) << response.head;
    EXPECT_EQ(response.head.find("EXCEPTION"), std::string::npos) << response.head;
  }
}

TEST_F(Door, RefusalsAreProblems) {
  const RawResponse response = ask(port_, request("GET", "/refuse"));
  EXPECT_EQ(response.status, 503);
  EXPECT_EQ(response.field("Content-Type"), "application/problem+json");
  EXPECT_EQ(response.field("Retry-After"), "7");
  EXPECT_EQ(response.body,
            "{\"type\":\"about:blank\",\"title\":\"Service Unavailable\",\"status\":503,\"detail\":\"as "
            "asked\",\"errors\":[{"
            "\"pointer\":\"/a\",\"detail\":\"wrong\"}]}\n");
}

// The library reads chunks past its payload limit, and a body without any framing until the connection ends.
TEST_F(Door, ChunkedAndUnframedBodiesAreRefusedBeforeTheyCome) {
  EXPECT_EQ(ask(port_, "POST / HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\nfffffff\r\n").status,
            411);
  EXPECT_EQ(ask(port_, "POST / HTTP/1.1\r\nHost: localhost\r\n\r\nsome bytes").status, 411);
  EXPECT_EQ(ask(port_, "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 2000000\r\n\r\n").status, 413);
}

// The library inflates a kilobyte of gzip to a megabyte, and 10 MB of it to 10 GB.
TEST_F(Door, CompressedBodiesAreRefused) {
  EXPECT_EQ(ask(port_, request("POST", "/", "Content-Encoding: gzip\r\n", "\x1f\x8b")).status, 415);
}

// The library buffers a header line as long as it comes.
TEST_F(Door, EndlessHeadsAreRefused) {
  EXPECT_EQ(ask(port_, "GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(20'000, 'x')).status, 431);
  EXPECT_EQ(ask(port_, "GET /" + std::string(20'000, 'x')).status, 414);
}

// The library answers a list of ranges with as many copies, and parses it with a recursive regular expression.
TEST_F(Door, ListsOfRangesAreNotServed) {
  std::string ranges = "Range: bytes=0-";
  for (int i = 0; i < 1'000; ++i) ranges += ",0-";
  const RawResponse response = ask(port_, request("GET", "/a", ranges + "\r\n"));
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(response.body, "GET /a []");
}

// The library leaves the rest of a refused request on the connection, where it is taken for the next one.
TEST_F(Door, WhatFollowsARefusedRequestIsNeverTakenForOne) {
  RawClient client(port_);
  client.send("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\nContent-Length: 60\r\n\r\n" +
              request("GET", "/hidden"));
  EXPECT_EQ(client.receive().status, 400);
  EXPECT_TRUE(client.is_closed());
}

TEST_F(Door, AnswersWithinMilliseconds) {
  RawClient client(port_);
  const auto begin = Clock::now();
  for (int i = 0; i < 20; ++i) {
    client.send(request("POST", "/a", "", "x"));
    ASSERT_EQ(client.receive().status, 200);
  }
  EXPECT_LT(Clock::now() - begin, 20 * 40ms) << "each waits for a delayed acknowledgement without TCP_NODELAY";
}

TEST_F(Door, ClientsThatAskWhetherToGoOnAreTold) {
  RawClient client(port_);
  client.send("POST /a HTTP/1.1\r\nHost: localhost\r\nContent-Length: 4\r\nExpect: 100-continue\r\n\r\n");
  EXPECT_EQ(client.receive().status, 100);
  client.send("body");
  EXPECT_EQ(client.receive().body, "POST /a [body]");
}

// The library sets SO_REUSEPORT: two instances share the port, and studies vanish into either.
TEST_F(Door, ASecondInstanceOnThePortIsRefused) {
  DoorOptions same = at_free_port();
  same.port = port_;
  try {
    const HttpServer second(same);
    FAIL() << "it listens too";
  } catch (const RunFailure& failure) {
    EXPECT_NE(std::string(failure.what()).find("in use"), std::string::npos) << failure.what();
  }
}

TEST(DoorOptions, BeyondLoopbackATokenIsNeeded) {
  DoorOptions open = at_free_port();
  open.host = "0.0.0.0";
  EXPECT_THROW(HttpServer{open}, BadUsage);
  open.token = "0123456789abcdef";
  const OpenServer server(open, echo);
  EXPECT_EQ(ask(server.port(), request("GET", "/a")).status, 401);
  EXPECT_EQ(ask(server.port(), request("GET", "/a", "Authorization: Bearer 0123456789abcdef\r\n")).status, 200);
}

// The library's time limits are for each read, and each of its 8 threads waits for one client: 8 that drip stop it.
TEST_F(Door, HundredsOfClientsThatDripHoldNobodyUp) {
  std::vector<std::unique_ptr<RawClient>> slow;
  for (int i = 0; i < 300; ++i) {
    slow.push_back(std::make_unique<RawClient>(port_));
    slow.back()->send(i % 2 == 0 ? "GET /a HTT"
                                 : "POST /a HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\nsome");
  }
  const auto begin = Clock::now();
  EXPECT_EQ(ask(port_, request("GET", "/healthz")).status, 200);
  EXPECT_LT(Clock::now() - begin, 1s);
}

TEST(DoorDeadlines, AHeadOrBodyThatDripsIsEndedHoweverOftenAByteComes) {
  DoorOptions quick = at_free_port();
  quick.limits = hasty();
  const OpenServer server(quick, echo);
  for (const std::string start :
       {"GET /a HTTP/1.1\r\n", "POST /a HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\n"}) {
    RawClient client(server.port());
    client.send(start);
    const auto begin = Clock::now();
    RawResponse response;
    while (response.status == 0 && Clock::now() - begin < 10s) {
      client.send("x");
      response = client.receive(false, 50ms);
    }
    EXPECT_EQ(response.status, 408) << start;
    EXPECT_TRUE(client.is_closed());
  }
}

TEST(DoorDeadlines, AConnectionWithoutRequestsIsClosed) {
  DoorOptions quick = at_free_port();
  quick.limits = hasty();
  const OpenServer server(quick, echo);
  RawClient fresh(server.port());
  RawClient used(server.port());
  used.send(request("GET", "/a"));
  EXPECT_EQ(used.receive().status, 200);
  EXPECT_TRUE(fresh.is_closed());
  EXPECT_TRUE(used.is_closed());
}

TEST(DoorDeadlines, AClientThatDoesNotReadItsAnswerLosesIt) {
  DoorOptions quick = at_free_port();
  quick.limits = hasty();
  quick.limits.workers = 1;
  const OpenServer server(quick, echo);
  RawClient deaf(server.port());
  deaf.send(request("GET", "/large"));
  EXPECT_EQ(ask(server.port(), request("GET", "/a")).status, 200) << "the one worker is free again";
}

TEST(DoorLimits, OfTooManyConnectionsTheOldestWithoutARequestGoes) {
  DoorOptions small = at_free_port();
  small.limits.connections = 4;
  const OpenServer server(small, echo);
  RawClient oldest(server.port());
  std::vector<std::unique_ptr<RawClient>> others;
  for (int i = 0; i < 4; ++i) others.push_back(std::make_unique<RawClient>(server.port()));
  EXPECT_TRUE(oldest.is_closed());
  others.back()->send(request("GET", "/a"));
  EXPECT_EQ(others.back()->receive().status, 200);
}

TEST(DoorLimits, RequestsUnderWayCountAmongTheConnections) {
  std::atomic<bool> released{false};
  DoorOptions small = at_free_port();
  small.limits.connections = 2;
  small.limits.workers = 1;
  const OpenServer server(small, [&](const httplib::Request& question, httplib::Response& answer) {
    while (!released) std::this_thread::sleep_for(1ms);
    echo(question, answer);
  });
  RawClient first(server.port());
  RawClient second(server.port());
  first.send(request("GET", "/a"));
  second.send(request("GET", "/b"));
  while (server.counters().in_flight < 2) std::this_thread::sleep_for(1ms);
  EXPECT_EQ(RawClient(server.port()).receive().status, 503);
  released = true;
  EXPECT_EQ(first.receive().body, "GET /a []");
  EXPECT_EQ(second.receive().body, "GET /b []");
}

TEST(HttpServerStop, AnswersWhatIsUnderWayAndTakesNothingMore) {
  std::atomic<bool> begun{false};
  auto server = std::make_unique<OpenServer>(at_free_port(), [&](const httplib::Request&, httplib::Response& response) {
    begun = true;
    std::this_thread::sleep_for(200ms);
    response.set_content("done", "text/plain");
  });
  const std::uint16_t port = server->port();
  RawClient client(port);
  client.send(request("GET", "/a"));
  while (!begun) std::this_thread::sleep_for(1ms);
  server->stop(10s);
  EXPECT_EQ(client.receive().body, "done");
  EXPECT_THROW(RawClient{port}, std::system_error);
}

}  // namespace
}  // namespace steerstat::testing
