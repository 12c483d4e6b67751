#include "hardening/listener.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <system_error>

#include "core/errors.hpp"

namespace steerstat {
namespace {

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

Addresses look_up(const std::string& host, int flags) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = flags;
  addrinfo* found = nullptr;
  if (getaddrinfo(host.c_str(), nullptr, &hints, &found) != 0) found = nullptr;
  return {found, &freeaddrinfo};
}

[[noreturn]] void fail_to_listen(const std::string& address, std::uint16_t port, int error) {
  std::string advice = std::generic_category().message(error);
  if (error == EADDRINUSE) advice = "the port is in use, perhaps by another steerstat; choose another one with --port";
  if (error == EACCES) advice = "ports below 1024 are root's; choose a higher one with --port";
  if (error == EADDRNOTAVAIL) advice = "this machine does not have the address; choose one of its own with --host";
  throw RunFailure(fmt::format("cannot listen at {} port {}: {}", address, port, advice));
}

std::uint16_t port_of(const sockaddr_storage& address) {
  if (address.ss_family == AF_INET6) {
    sockaddr_in6 six{};
    std::memcpy(&six, &address, sizeof six);
    return ntohs(six.sin6_port);
  }
  sockaddr_in four{};
  std::memcpy(&four, &address, sizeof four);
  return ntohs(four.sin_port);
}

/// Copies an address with its port set.
sockaddr_storage with_port(const addrinfo& address, std::uint16_t port) {
  sockaddr_storage result{};
  std::memcpy(&result, address.ai_addr, address.ai_addrlen);
  const std::uint16_t network = htons(port);
  const std::size_t offset =
      address.ai_family == AF_INET6 ? offsetof(sockaddr_in6, sin6_port) : offsetof(sockaddr_in, sin_port);
  std::memcpy(reinterpret_cast<char*>(&result) + offset, &network, sizeof network);
  return result;
}

}  // namespace

std::string Listener::url() const {
  const bool six = address.find(':') != std::string::npos;
  std::string shown = address;
  if (address == "0.0.0.0") shown = "127.0.0.1";
  if (address == "::") shown = "::1";
  return six ? fmt::format("http://[{}]:{}", shown, port) : fmt::format("http://{}:{}", shown, port);
}

std::string resolve(const std::string& host) {
  const Addresses found = look_up(host, AI_PASSIVE);
  char text[NI_MAXHOST];
  if (!found || getnameinfo(found->ai_addr, found->ai_addrlen, text, sizeof text, nullptr, 0, NI_NUMERICHOST) != 0) {
    throw BadUsage(
        fmt::format("--host: there is no address {}; use an address of this machine, such as 127.0.0.1", host));
  }
  return text;
}

Listener listen_at(const std::string& address, std::uint16_t port) {
  const Addresses found = look_up(address, AI_NUMERICHOST | AI_PASSIVE);
  if (!found) fail_to_listen(address, port, EADDRNOTAVAIL);
  Listener listener{FileDescriptor(socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)), address,
                    port};
  const int descriptor = listener.socket.get();
  if (descriptor < 0) fail_to_listen(address, port, errno);
  // Connections of an earlier instance that still fade away do not hinder; SO_REUSEPORT is left off.
  const int on = 1;
  setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_storage name = with_port(*found, port);
  if (bind(descriptor, reinterpret_cast<const sockaddr*>(&name), found->ai_addrlen) != 0 ||
      listen(descriptor, 256) != 0) {
    fail_to_listen(address, port, errno);
  }
  socklen_t size = sizeof name;
  if (getsockname(descriptor, reinterpret_cast<sockaddr*>(&name), &size) != 0) fail_to_listen(address, port, errno);
  listener.port = port_of(name);
  return listener;
}

}  // namespace steerstat
