#include "hardening/admission.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "hardening/token.hpp"

namespace steerstat {
namespace {

const std::string token = "0123456789abcdef0123456789abcdef";

/// The status a GET with these fields is refused with, 0 where it is let in.
int refusal(const Admission& admission, const std::string& fields, const std::string& target = "/v1/studies") {
  try {
    admit(parse_head("GET " + target + " HTTP/1.1\r\n" + fields + "\r\n", DoorLimits{}), admission);
  } catch (const Refused& refused) {
    return refused.problem().status;
  }
  return 0;
}

const Admission local{{"localhost", "127.0.0.1", "::1"}, false, {}};

TEST(Admission, OnlyItsOwnNamesAreAnswered) {
  for (const std::string host : {"localhost", "LocalHost:8080", "127.0.0.1:1", "[::1]:8080", "[::1]"}) {
    EXPECT_EQ(refusal(local, "Host: " + host + "\r\n"), 0) << host;
  }
  for (const std::string host : {"evil.example", "localhost.evil.example", "10.0.0.1", "", "localhost:80:80",
                                 "localhost:x", "[::1", "user@localhost", "localhost/"}) {
    EXPECT_EQ(refusal(local, "Host: " + host + "\r\n"), 421) << host;
  }
}

TEST(Admission, BoundToEveryAddressItAnswersToAnyAddressButNotToAnyName) {
  const Admission open{{"localhost", "lab"}, true, {}};
  for (const std::string host : {"10.0.0.1:8080", "[2001:db8::1]:8080", "lab:8080"}) {
    EXPECT_EQ(refusal(open, "Host: " + host + "\r\n"), 0) << host;
  }
  EXPECT_EQ(refusal(open, "Host: evil.example\r\n"), 421);
}

TEST(Admission, PagesOfOtherSitesAreRefused) {
  EXPECT_EQ(refusal(local, "Host: localhost:8080\r\nOrigin: http://localhost:8080\r\n"), 0);
  EXPECT_EQ(refusal(local, "Host: localhost\r\nOrigin: http://localhost:80\r\n"), 0);
  EXPECT_EQ(refusal(local, "Host: localhost\r\nOrigin: https://localhost\r\n"), 0) << "behind a proxy that speaks TLS";
  for (const std::string origin : {"http://evil.example", "null", "http://localhost:8081",
                                   "http://localhost:8080.evil.example", "file://", "localhost:8080", ""}) {
    EXPECT_EQ(refusal(local, "Host: localhost:8080\r\nOrigin: " + origin + "\r\n"), 403) << origin;
  }
}

TEST(Admission, OtherSitesMayLinkHereButNotLoadAnything) {
  EXPECT_EQ(refusal(local, "Host: localhost\r\nSec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: no-cors\r\n"), 403);
  EXPECT_EQ(refusal(local, "Host: localhost\r\nSec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: navigate\r\n"), 0);
  EXPECT_EQ(refusal(local, "Host: localhost\r\nSec-Fetch-Site: same-origin\r\nSec-Fetch-Mode: cors\r\n"), 0);
}

TEST(Admission, WhereATokenIsAskedForItMustBeShown) {
  const Admission guarded{{"localhost"}, false, token};
  EXPECT_EQ(refusal(guarded, "Host: localhost\r\n"), 401);
  EXPECT_EQ(refusal(guarded, "Host: localhost\r\nAuthorization: Bearer " + token + "\r\n"), 0);
  EXPECT_EQ(refusal(guarded, "Host: localhost\r\nAuthorization: bearer " + token + "\r\n"), 0);
  for (const std::string shown :
       {"Bearer", "Bearer ", "Bearer 0", "Token 0", "", "Bearer 0123456789abcdef0123456789abcdee"}) {
    EXPECT_EQ(refusal(guarded, "Host: localhost\r\nAuthorization: " + shown + "\r\n"), 401) << shown;
  }
  EXPECT_EQ(refusal(guarded, "Host: localhost\r\nAuthorization: Bearer " + token + "0\r\n"), 401);
  EXPECT_EQ(refusal(guarded, "Host: localhost\r\n", "/healthz"), 0);
  EXPECT_EQ(refusal(guarded, "Host: localhost\r\n", "/healthz/../v1/studies"), 401);
}

TEST(Admission, BrowsersMayShowTheTokenAsAPassword) {
  EXPECT_TRUE(shows_token("Basic bGFiOjAxMjM0NTY3ODlhYmNkZWYwMTIzNDU2Nzg5YWJjZGVm", token));  // lab:TOKEN
  EXPECT_FALSE(shows_token("Basic bGFiOjAxMjM0NTY3ODlhYmNkZWY=", token));                     // half of it
  for (const std::string shown : {"Basic", "Basic ", "Basic ====", "Basic !!!!", "Basic bGFi", "Basic b"}) {
    EXPECT_FALSE(shows_token(shown, token)) << shown;
  }
}

TEST(IsLoopback, TellsThisMachineFromOthers) {
  for (const std::string address : {"127.0.0.1", "127.255.0.9", "::1"}) EXPECT_TRUE(is_loopback(address)) << address;
  for (const std::string address : {"0.0.0.0", "::", "128.0.0.1", "10.0.0.1", "localhost", ""}) {
    EXPECT_FALSE(is_loopback(address)) << address;
  }
}

class TokenFile : public ::testing::Test {
 protected:
  ~TokenFile() override { std::filesystem::remove(path_); }
  /// @return what is wrong with a token file of this content, "" where nothing is
  std::string mistake(const std::string& content, mode_t mode = 0600) {
    std::ofstream(path_, std::ios::binary) << content;
    chmod(path_.c_str(), mode);
    try {
      read_ = read_token_file(path_);
      return "";
    } catch (const BadUsage& bad) {
      return bad.what();
    }
  }

  std::string path_ = std::filesystem::temp_directory_path() / ("steerstat-token-" + std::to_string(getpid()));
  std::string read_;
};

TEST_F(TokenFile, IsOneLineThatIsLongEnough) {
  EXPECT_EQ(mistake(token + "\n"), "");
  EXPECT_EQ(read_, token);
  EXPECT_EQ(mistake(std::string(shortest_token, 'x')), "");
  EXPECT_NE(mistake(std::string(shortest_token - 1, 'x')), "");
  for (const std::string& content : {std::string(), token + " x", token + "\n" + token + "\n", token + "\n\n"}) {
    EXPECT_NE(mistake(content), "") << content;
  }
}

TEST_F(TokenFile, IsNobodyElses) {
  EXPECT_EQ(mistake(token, 0640), "");
  EXPECT_NE(mistake(token, 0620).find("chmod 600"), std::string::npos);
  EXPECT_NE(mistake(token, 0604).find("chmod 600"), std::string::npos);
  EXPECT_THROW(read_token_file("/nonexistent/token"), BadUsage);
}

}  // namespace
}  // namespace steerstat
