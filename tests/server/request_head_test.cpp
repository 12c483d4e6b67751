#include "hardening/request_head.hpp"

#include <gtest/gtest.h>

#include <string>

namespace steerstat {
namespace {

RequestHead parsed(const std::string& text) {
  return parse_head(text, DoorLimits{});
}

/// The status that a head is refused with, 0 where it is taken.
int refusal(const std::string& text) {
  try {
    parsed(text);
  } catch (const Refused& refused) {
    return refused.problem().status;
  }
  return 0;
}

std::string get(const std::string& fields) {
  return "GET / HTTP/1.1\r\nHost: a\r\n" + fields + "\r\n";
}

std::string post(const std::string& fields) {
  return "POST / HTTP/1.1\r\nHost: a\r\n" + fields + "\r\n";
}

TEST(RequestHead, HasWhatWasSent) {
  const RequestHead head =
      parsed("POST /v1/studies?x=1 HTTP/1.1\r\nHost: a:80\r\nContent-Length:  12 \r\nX-Y: \r\n\r\n");
  EXPECT_EQ(head.method, "POST");
  EXPECT_EQ(head.target, "/v1/studies?x=1");
  EXPECT_EQ(head.content_length, 12U);
  EXPECT_EQ(head.field("host"), "a:80");
  EXPECT_TRUE(head.has("x-y"));
  EXPECT_FALSE(head.has("x"));
  EXPECT_TRUE(head.keeps_alive);
}

TEST(RequestHead, ConnectionsAreKeptUnlessOneSideCannotOrDoesNotWantTo) {
  EXPECT_TRUE(parsed(get("")).keeps_alive);
  EXPECT_FALSE(parsed(get("Connection: close\r\n")).keeps_alive);
  EXPECT_FALSE(parsed(get("Connection: upgrade , Close\r\n")).keeps_alive);
  EXPECT_FALSE(parsed("GET / HTTP/1.0\r\n\r\n").keeps_alive);
}

TEST(RequestHead, LinesThatAreNoHeaderAreRefused) {
  for (const std::string line :
       {"no colon", "name : value", " folded: x", ": value", "a\tb: c", "a: b\x01", "a: b\rc: d", "a: b\nc: d"}) {
    EXPECT_EQ(refusal(get(line + "\r\n")), 400) << line;
  }
  EXPECT_EQ(refusal(get("a: b\r\n folded\r\n")), 400);
  EXPECT_EQ(refusal(get(std::string("a: b\0c\r\n", 8))), 400);
}

TEST(RequestHead, RequestLinesThatLeadNowhereAreRefused) {
  for (const std::string line :
       {"GET", "GET /", "GET  HTTP/1.1", "GET http://a/ HTTP/1.1", "GET * HTTP/1.1", "GET /a b HTTP/1.1",
        "GET /\x80 HTTP/1.1", "GET /#x HTTP/1.1", "G(T / HTTP/1.1", "GET /\tx HTTP/1.1"}) {
    EXPECT_EQ(refusal(line + "\r\nHost: a\r\n\r\n"), 400) << line;
  }
  EXPECT_EQ(refusal("GET / HTTP/2.0\r\nHost: a\r\n\r\n"), 505);
  EXPECT_EQ(refusal("GET / HTTP/1.1\r\n\r\n"), 400) << "no Host";
}

TEST(RequestHead, TargetsAreTakenUpToTheirLimit) {
  const std::size_t limit = DoorLimits{}.target_bytes;
  EXPECT_EQ(refusal("GET /" + std::string(limit - 1, 'a') + " HTTP/1.1\r\nHost: a\r\n\r\n"), 0);
  EXPECT_EQ(refusal("GET /" + std::string(limit, 'a') + " HTTP/1.1\r\nHost: a\r\n\r\n"), 414);
}

TEST(RequestHead, FieldsAreTakenUpToTheirLimit) {
  std::string fields;
  for (std::size_t i = 1; i < DoorLimits{}.fields; ++i) fields += "a: b\r\n";
  EXPECT_EQ(refusal(get(fields)), 0);
  EXPECT_EQ(refusal(get(fields + "a: b\r\n")), 431);
}

TEST(RequestHead, AFieldIsTakenUpToItsLimit) {
  const std::size_t limit = DoorLimits{}.field_bytes;
  EXPECT_EQ(refusal(get("a: " + std::string(limit - 3, 'x') + "\r\n")), 0);
  EXPECT_EQ(refusal(get("a: " + std::string(limit - 2, 'x') + "\r\n")), 431);
}

TEST(RequestHead, OneOpinionOnTheLengthIsTaken) {
  EXPECT_EQ(refusal(post("Content-Length: 5\r\nContent-Length: 5\r\n")), 400);
  EXPECT_EQ(refusal(post("Content-Length: 5\r\nContent-Length: 6\r\n")), 400);
  for (const std::string value : {"5, 5", "-1", "+5", "0x5", "5 5", "", "five", "5.0"}) {
    EXPECT_EQ(refusal(post("Content-Length: " + value + "\r\n")), 400) << value;
  }
  EXPECT_EQ(refusal(post("Content-Length: 5\r\nTransfer-Encoding: chunked\r\n")), 411);
  EXPECT_EQ(refusal(post("Transfer-Encoding: chunked\r\n")), 411);
  EXPECT_EQ(refusal(post("")), 411);
  EXPECT_EQ(refusal(get("Content-Length: 5\r\n")), 400);
  EXPECT_EQ(refusal(get("Content-Length: 0\r\n")), 0);
}

TEST(RequestHead, BodiesAreTakenUpToTheirLimit) {
  EXPECT_EQ(refusal(post("Content-Length: 1048576\r\n")), 0);
  EXPECT_EQ(refusal(post("Content-Length: 1048577\r\n")), 413);
  EXPECT_EQ(refusal(post("Content-Length: 99999999999999999999999999\r\n")), 413);
}

TEST(RequestHead, CompressedBodiesAreRefused) {
  for (const std::string coding : {"gzip", "br", "deflate", "gzip, gzip"}) {
    EXPECT_EQ(refusal(post("Content-Length: 5\r\nContent-Encoding: " + coding + "\r\n")), 415) << coding;
  }
  EXPECT_EQ(refusal(post("Content-Length: 5\r\nContent-Encoding: identity\r\n")), 0);
}

TEST(RequestHead, FieldsThatGuardTheRequestAreThereOnce) {
  for (const std::string name : {"Host", "Origin", "Authorization", "Content-Type", "Range", "Expect"}) {
    EXPECT_EQ(refusal("GET / HTTP/1.1\r\nHost: a\r\n" + name + ": 100-continue\r\n" + name + ": 100-continue\r\n\r\n"),
              400)
        << name;
  }
  EXPECT_EQ(refusal(get("Accept: a\r\nAccept: b\r\n")), 0);
}

TEST(RequestHead, OneExpectationIsMet) {
  EXPECT_TRUE(parsed(post("Content-Length: 5\r\nExpect: 100-Continue\r\n")).expects_continue);
  EXPECT_EQ(refusal(post("Content-Length: 5\r\nExpect: miracles\r\n")), 417);
}

}  // namespace
}  // namespace steerstat
