#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hardening/door_limits.hpp"
#include "hardening/problem.hpp"

namespace httplib {
struct Request;
struct Response;
}  // namespace httplib

namespace steerstat {

/// Where to serve, and whom.
struct DoorOptions {
  std::string host{"127.0.0.1"};             ///< name or address to listen at
  std::uint16_t port{8080};                  ///< 0: a free one
  std::optional<std::string> token{};        ///< that clients must show
  std::vector<std::string> allowed_hosts{};  ///< further names that clients may know the service by
  DoorLimits limits{};
};

/// What has come to the door. Each counts from the start.
struct DoorCounters {
  std::uint64_t answered{0};                             ///< requests that reached the handler
  std::vector<std::pair<int, std::uint64_t>> refused{};  ///< (status, requests) that did not
  std::size_t in_flight{0};                              ///< requests being answered now
  std::size_t waiting{0};                                ///< connections without a whole request
};

/// An HTTP/1.1 server that hostile, slow and broken clients cannot hold up. Whole, strictly framed and admitted
/// requests go to the handler on one of `limits.workers` threads.
///
/// Of cpp-httplib it uses the message formats, the thread pool and the streaming of contents. It does not use the
/// library's own listening, reading and routing: those of 0.11.4 share the port with a second instance, give up at the
/// first transient error of accept(), occupy a thread for a client that drips, buffer header lines without bound, take
/// chunked and compressed bodies past the payload limit, multiply memory by lists of ranges, lose track of the framing
/// after unread bodies, put exceptions into headers and match paths with recursive regular expressions.
class HttpServer {
 public:
  /// Answers a request; runs on many threads at once. What it throws becomes a problem: Refused as it says, all else a
  /// 500 without particulars.
  using Handler = std::function<void(const httplib::Request&, httplib::Response&)>;
  /// Hears of what the handler threw and should not have. Runs on many threads at once; may be empty.
  using OnBug = std::function<void(const std::string&)>;

  /// Listens. What comes is answered once it is open.
  /// @throws BadUsage for a host that is none, and for one beyond loopback without a token; RunFailure where it cannot
  ///         listen
  explicit HttpServer(DoorOptions options);

  /// As stop() with no grace.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Answers requests from now on. Once. @throws RunFailure
  void open(Handler handler, OnBug on_bug = {});

  /// Takes no further request, and waits until those under way are answered; after the grace they are cut off.
  /// Idempotent; not thread-safe with itself.
  void stop(std::chrono::milliseconds grace = std::chrono::milliseconds(0));

  [[nodiscard]] std::uint16_t port() const;
  /// `http://127.0.0.1:8080`
  [[nodiscard]] std::string url() const;
  /// Thread-safe once it is open.
  [[nodiscard]] DoorCounters counters() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Makes a response say a problem.
void answer_with(httplib::Response& response, const Problem& problem);

}  // namespace steerstat
