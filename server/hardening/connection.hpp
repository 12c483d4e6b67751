#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

#include "hardening/file_descriptor.hpp"
#include "hardening/request_head.hpp"

namespace steerstat {

/// A client's connection between two requests and while one comes in.
struct Connection {
  using Clock = std::chrono::steady_clock;

  /// idle: nothing of a request is there; lingering: all is said, and what still comes is thrown away.
  enum class Phase : std::uint8_t { idle, head, body, lingering };

  FileDescriptor socket;
  Phase phase{Phase::idle};
  std::string received{};  ///< and not yet used
  RequestHead head{};      ///< from Phase::body on
  Clock::time_point deadline{};
};

/// A request that is wholly there, with the connection it came by.
struct Arrival {
  Connection connection;  ///< its head is the request's
  std::string body;
};

}  // namespace steerstat
