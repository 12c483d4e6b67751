#pragma once

#include <httplib.h>

#include <atomic>
#include <chrono>
#include <string>

#include "hardening/door_limits.hpp"

namespace steerstat {

/// What cpp-httplib reads a request's head from and writes its response to. Reads come from memory alone, so that
/// nothing of the client's reaches the library that has not been looked at whole; writes end when the client takes them
/// too slowly.
class ResponseStream : public httplib::Stream {
 public:
  /// @param socket  does not block; must outlive the stream
  /// @param head    what is read
  /// @param cut     ends writing as soon as it is true; must outlive the stream
  ResponseStream(int socket, std::string head, const DoorLimits& limits, const std::atomic<bool>& cut);

  [[nodiscard]] bool is_readable() const override { return read_ < head_.size(); }
  /// Whether the client is still there to read.
  [[nodiscard]] bool is_writable() const override;
  ssize_t read(char* data, std::size_t size) override;
  /// Writes all of it. @return its size, or -1 once the client is gone, too slow, or the stream is cut
  ssize_t write(const char* data, std::size_t size) override;
  void get_remote_ip_and_port(std::string& address, int& port) const override;
  void get_local_ip_and_port(std::string& address, int& port) const override;
  [[nodiscard]] socket_t socket() const override { return socket_; }

  /// Of the response as it was written; 0 before.
  [[nodiscard]] int status() const { return status_; }
  /// Whether all was written and the client can tell where it ends, so that another request may follow.
  [[nodiscard]] bool ended_well() const { return !failed_ && framed_; }

 private:
  void look_at_head(std::string_view text);
  void count(std::size_t taken);

  int socket_;
  std::string head_;
  std::size_t read_{0};
  DoorLimits limits_;
  const std::atomic<bool>& cut_;
  int status_{0};
  bool framed_{false};
  bool failed_{false};
  std::size_t taken_{0};                 ///< [bytes] by the client, of the piece under way
  std::chrono::nanoseconds blocked_{0};  ///< that the client let writes wait meanwhile
};

}  // namespace steerstat
