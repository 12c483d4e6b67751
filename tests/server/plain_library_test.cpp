// What cpp-httplib lets through when it serves by itself: why the door is there. Where one of these fails, the library
// has mended it, and something in server/hardening may go.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>

#include <chrono>
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
    server_.Post("/a", [](const httplib::Request& request, httplib::Response& response) {
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
