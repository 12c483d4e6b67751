#pragma once

#include <cstdint>
#include <string>

#include "hardening/file_descriptor.hpp"

namespace steerstat {

/// A socket that listens.
struct Listener {
  FileDescriptor socket;
  std::string address;  ///< bound to, as numbers
  std::uint16_t port{0};

  /// Where it is found: `http://127.0.0.1:8080`, with the machine's own address where it is bound to all.
  [[nodiscard]] std::string url() const;
};

/// The first address of a name or of an address. @throws BadUsage where it has none
std::string resolve(const std::string& host);

/// Listens, without blocking. Never on a port where another process listens, though that one allows it: the system
/// would deal the connections out among the two.
///
/// @param address  as numbers
/// @param port     0: a free one
/// @throws RunFailure naming the cause: the port in use, reserved to root, the address not of this machine
Listener listen_at(const std::string& address, std::uint16_t port);

}  // namespace steerstat
