// What cpp-httplib lets through when it serves by itself: why the door is there. Where one of these fails, the library
// has mended it, and something in server/hardening may go.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "raw_client.hpp"

namespace steerstat::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

class PlainLibrary : public ::testing::Test {
 protected:
  PlainLibrary() {
    server_.set_payload_max_length(1000);
    server_.Get("/a", [](const httplib::Request&, httplib::Response& response) {
      response.set_content(std::string(1000, 'x'), "text/plain");
    });
    server_.Get("/throw", [](const httplib::Request&, httplib::Response&) { throw std::runtime_error("a secret"); });
    server_.Post("/a", [this](const httplib::Request& request, httplib::Response& response) {
      largest_body_ = std::max<std::size_t>(largest_body_, request.body.size());
      response.set_content(std::to_string(request.body.size()), "text/plain");
    });
    port_ = static_cast<std::uint16_t>(server_.bind_to_any_port("127.0.0.1"));
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    while (!server_.is_running()) std::this_thread::sleep_for(1ms);
  }
  ~PlainLibrary() override {
    server_.stop();
    thread_.join();
  }

  httplib::Server server_;
  std::uint16_t port_{0};
  std::atomic<std::size_t> largest_body_{0};
  std::thread thread_;
};

TEST_F(PlainLibrary, LetsASecondInstanceShareThePort) {
  httplib::Server second;
  EXPECT_TRUE(second.bind_to_port("127.0.0.1", port_));
}

TEST_F(PlainLibrary, TellsClientsWhatWasThrown) {
  EXPECT_THAT(ask(port_, request("GET", "/throw")).head, HasSubstr("a secret"));
}

TEST_F(PlainLibrary, TakesChunkedBodiesBeyondThePayloadLimit) {
  const RawResponse response = ask(port_, "POST /a HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n1388\r\n" +
                                              std::string(5000, 'x') + "\r\n0\r\n\r\n");
  EXPECT_EQ(response.body, "5000");
}

TEST_F(PlainLibrary, TakesBodiesWithoutFramingBeyondThePayloadLimit) {
  RawClient client(port_);
  client.send("POST /a HTTP/1.1\r\nHost: a\r\n\r\n" + std::string(5000, 'x'));
  client.end();
  EXPECT_TRUE(client.is_closed());  // it takes a client that sends nothing more for gone
  EXPECT_EQ(largest_body_, 5000U);
}

TEST_F(PlainLibrary, InflatesCompressedBodiesBeyondThePayloadLimit) {
  const std::string plain(900'000, 'x');
  std::string compressed;
  httplib::detail::gzip_compressor().compress(plain.data(), plain.size(), true,
                                              [&](const char* bytes, std::size_t size) {
                                                compressed.append(bytes, size);
                                                return true;
                                              });
  ASSERT_LT(compressed.size(), 1000U);
  EXPECT_EQ(ask(port_, request("POST", "/a", "Content-Encoding: gzip\r\n", compressed)).body, "900000");
}

// Far more than the system's own buffers hold: the server has taken it.
TEST_F(PlainLibrary, BuffersAHeaderLineAsLongAsItComes) {
  RawClient client(port_);
  EXPECT_TRUE(client.send("GET /a HTTP/1.1\r\nX: " + std::string(std::size_t{64} << 20U, 'x')));
}

TEST_F(PlainLibrary, TakesTheFirstOfTwoLengthsAndTheRestForTheNextRequest) {
  RawClient client(port_);
  client.send("POST /a HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\nContent-Length: 60\r\n\r\nabcde");
  EXPECT_EQ(client.receive().body, "5");
  client.send(request("GET", "/a"));
  EXPECT_EQ(client.receive().body.size(), 1000U) << "the hidden one was answered";
}

// Its time limits are those of a read.
TEST_F(PlainLibrary, WaitsForAHeadThatDripsLongerThanItsTimeLimit) {
  server_.set_read_timeout(1s);
  RawClient client(port_);
  const auto begin = std::chrono::steady_clock::now();
  for (const char byte : std::string("GET /a")) {
    client.send(std::string(1, byte));
    std::this_thread::sleep_for(250ms);
  }
  ASSERT_GT(std::chrono::steady_clock::now() - begin, 1s);
  client.send(" HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_EQ(client.receive().status, 200);
}

TEST_F(PlainLibrary, LetsClientsWaitForTheirDelayedAcknowledgement) {
  server_.set_keep_alive_max_count(100);
  RawClient client(port_);
  auto longest = 0ms;
  for (int i = 0; i < 40; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    client.send(request("POST", "/a", "", "x"));
    ASSERT_EQ(client.receive().status, 200);
    longest = std::max(longest,
                       std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - begin));
  }
  EXPECT_GE(longest, 35ms);
}

TEST(PlainLibraryDeathTest, DiesOfALongPathWhereRoutesHaveNestedGroups) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto serve_one = [] {
    httplib::Server server;
    server.Get(R"(/((a|b)*)*)", [](const httplib::Request&, httplib::Response&) {});
    const auto port = static_cast<std::uint16_t>(server.bind_to_any_port("127.0.0.1"));
    const std::thread thread([&] { server.listen_after_bind(); });
    while (!server.is_running()) std::this_thread::sleep_for(1ms);
    ask(port, request("GET", "/" + std::string(8000, 'a')));
    std::_Exit(0);
  };
  EXPECT_DEATH(serve_one(), "");
}

TEST_F(PlainLibrary, AnswersAListOfRangesWithAsManyCopies) {
  std::string ranges = "Range: bytes=0-999";
  for (int i = 0; i < 500; ++i) ranges += ",0-999";
  EXPECT_GT(ask(port_, request("GET", "/a", ranges + "\r\n")).body.size(), 500'000U);
}

TEST_F(PlainLibrary, TakesTheBodyOfAGetForTheNextRequest) {
  RawClient client(port_);
  const std::string hidden = request("GET", "/a");
  client.send("GET /a HTTP/1.1\r\nHost: a\r\nContent-Length: " + std::to_string(hidden.size()) + "\r\n\r\n");
  EXPECT_EQ(client.receive().status, 200);
  client.send(hidden);  // its body
  EXPECT_EQ(client.receive(false, 2s).status, 200) << "the hidden one was answered";
}

TEST_F(PlainLibrary, IsStoppedByAsManyIdleClientsAsItHasThreads) {
  std::vector<std::unique_ptr<RawClient>> idle;
  for (std::size_t i = 0; i < CPPHTTPLIB_THREAD_POOL_COUNT; ++i) idle.push_back(std::make_unique<RawClient>(port_));
  std::this_thread::sleep_for(50ms);
  RawClient client(port_);
  client.send(request("GET", "/a"));
  EXPECT_EQ(client.receive(false, 1s).status, 0);
}

}  // namespace
}  // namespace steerstat::testing
