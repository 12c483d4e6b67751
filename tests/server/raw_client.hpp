#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "hardening/file_descriptor.hpp"

namespace steerstat::testing {

/// A response as it came.
struct RawResponse {
  int status{0};     ///< 0: none came
  std::string head;  ///< status line and fields
  std::string body;

  /// The value of a field, "" where it is not there. @param name  as it is sent
  [[nodiscard]] std::string field(const std::string& name) const;
};

/// Speaks whatever bytes a test wants to 127.0.0.1. What is answered is noted (recorder.hpp).
class RawClient {
 public:
  explicit RawClient(std::uint16_t port);
  ~RawClient();
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  /// @return whether the other side took all of it
  bool send(const std::string& bytes);
  /// Sends nothing more, and says so.
  void end();
  /// One response with a Content-Length, or without a body. @param head_only  it answers a HEAD
  RawResponse receive(bool head_only = false, std::chrono::milliseconds patience = std::chrono::seconds(20));
  /// All until `text` has come or the other side closes; what was left of it too.
  std::string receive_until(const std::string& text, std::chrono::milliseconds patience = std::chrono::seconds(20));
  /// Whether the other side ends the connection, all that it sent having been read.
  bool is_closed(std::chrono::milliseconds patience = std::chrono::seconds(20));

 private:
  bool fill(std::chrono::steady_clock::time_point end);
  std::string take_request();

  const std::uint16_t port_;
  FileDescriptor socket_;
  std::string sent_;      // requests that are not answered yet
  std::string received_;  // and not taken yet
  std::string streamed_;  // taken piece by piece
};

/// Sends a request on a connection of its own.
RawResponse ask(std::uint16_t port, const std::string& bytes);

/// `METHOD TARGET` with Host, the further fields (each ending in CRLF) and the body with its length.
std::string request(const std::string& method, const std::string& target, const std::string& fields = "",
                    const std::string& body = "");

}  // namespace steerstat::testing
