#include "hardening/reception.hpp"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "core/errors.hpp"

namespace steerstat {
namespace {

using Clock = Connection::Clock;
using Phase = Connection::Phase;

constexpr std::string_view end_of_head = "\r\n\r\n";

/// Sends what the socket takes at once: a connection's first few hundred bytes are always taken.
void send_now(int descriptor, std::string_view text) {
  while (send(descriptor, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT) < 0 && errno == EINTR) {
  }
}

int milliseconds_until(Clock::time_point moment) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(moment - Clock::now()).count();
  return static_cast<int>(std::clamp<decltype(left)>(left, 0, 1000));
}

}  // namespace

std::string problem_response(const Problem& problem) {
  const std::string body = problem_json(problem);
  std::string text = fmt::format("HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\n", problem.status,
                                 phrase_of(problem.status), problem_type, body.size());
  for (const auto& [name, value] : problem.headers) text += fmt::format("{}: {}\r\n", name, value);
  return text + "Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n" + body;
}

Reception::Reception(FileDescriptor listening, Admission admission, DoorLimits limits, OnArrival on_arrival,
                     OnRefusal on_refusal)
    : listening_(std::move(listening)),
      admission_(std::move(admission)),
      limits_(limits),
      on_arrival_(std::move(on_arrival)),
      on_refusal_(std::move(on_refusal)),
      wake_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (wake_.get() < 0) throw RunFailure("cannot begin to serve: the system has no file descriptor left");
}

void Reception::start() {
  thread_ = std::thread([this] { receive(); });
}

Reception::~Reception() {
  stop();
}

void Reception::stop() {
  stopping_ = true;
  wake();
  if (thread_.joinable()) thread_.join();
}

void Reception::wake() const {
  const std::uint64_t one = 1;
  while (write(wake_.get(), &one, sizeof one) < 0 && errno == EINTR) {
  }
}

void Reception::take_back(Connection connection, bool keep) {
  --away_;
  const auto now = Clock::now();
  if (keep) {
    connection.phase = connection.received.empty() ? Phase::idle : Phase::head;
    connection.deadline = now + (connection.received.empty() ? limits_.idle_time : limits_.head_time);
  } else {
    linger(connection);
  }
  {
    const std::lock_guard lock(mutex_);
    returned_.push_back(std::move(connection));
  }
  wake();
}

/// Says that nothing more is coming, and lets the client read all there was: closed at once with bytes of the client's
/// unread, the connection would be reset, and the answer with it.
void Reception::linger(Connection& connection) {
  shutdown(connection.socket.get(), SHUT_WR);
  connection.received.clear();
  connection.phase = Phase::lingering;
  connection.deadline = Clock::now() + limits_.linger_time;
}

void Reception::receive() {
  while (!stopping_) {
    try {
      run_once();
    } catch (...) {  // out of memory: what was being received is lost, and the service goes on
      connections_.clear();
    }
  }
  connections_.clear();
  listening_ = FileDescriptor();
}

void Reception::run_once() {
  take_returned();
  const bool accepting = Clock::now() >= accepting_from_;
  std::vector<pollfd> waits{{wake_.get(), POLLIN, 0}, {accepting ? listening_.get() : -1, POLLIN, 0}};
  Clock::time_point soonest = Clock::now() + std::chrono::seconds(1);
  if (!accepting) soonest = std::min(soonest, accepting_from_);
  for (const Connection& connection : connections_) {
    waits.push_back({connection.socket.get(), POLLIN, 0});
    soonest = std::min(soonest, connection.deadline);
  }
  if (poll(waits.data(), waits.size(), milliseconds_until(soonest)) < 0) return;
  if (waits[0].revents != 0) {
    std::uint64_t ignored = 0;
    while (read(wake_.get(), &ignored, sizeof ignored) < 0 && errno == EINTR) {
    }
  }
  std::size_t index = 2;
  for (auto connection = connections_.begin(); connection != connections_.end(); ++index) {
    bool keep = true;
    if (waits[index].revents != 0) keep = on_readable(*connection);
    if (keep && Clock::now() >= connection->deadline) keep = on_deadline(*connection);
    connection = keep ? std::next(connection) : connections_.erase(connection);
  }
  if (waits[1].revents != 0) accept_all();
  waiting_ = connections_.size();
}

void Reception::take_returned() {
  std::vector<Connection> returned;
  {
    const std::lock_guard lock(mutex_);
    returned.swap(returned_);
  }
  for (Connection& connection : returned) {
    connections_.push_back(std::move(connection));
    // The next request may have come together with the last one.
    if (connections_.back().phase == Phase::head && !advance(connections_.back())) connections_.pop_back();
  }
}

void Reception::accept_all() {
  for (int taken = 0; taken < 64; ++taken) {
    FileDescriptor socket(accept4(listening_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (socket.get() < 0) {
      const bool short_of_something = errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM;
      if (short_of_something) accepting_from_ = Clock::now() + std::chrono::milliseconds(100);
      return;  // also when the client has gone again meanwhile: poll tells of the next
    }
    // Else an answer's last bytes wait for the client's acknowledgement, which it delays by 40 ms.
    const int on = 1;
    setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    if (!make_room()) {
      on_refusal_(503);
      send_now(socket.get(), problem_response({503, "too many requests are under way", {}, {{"Retry-After", "5"}}}));
      continue;
    }
    Connection connection;
    connection.socket = std::move(socket);
    connection.deadline = Clock::now() + limits_.idle_time;
    connections_.push_back(std::move(connection));
  }
}

/// Lets the connection go that has waited longest, where there are too many. @return whether there is room now
bool Reception::make_room() {
  while (connections_.size() + away_ >= limits_.connections) {
    if (connections_.empty()) return false;
    connections_.pop_front();
  }
  return true;
}

/// @return whether the connection stays here
bool Reception::on_readable(Connection& connection) {
  std::array<char, 16384> buffer;
  const ssize_t count = recv(connection.socket.get(), buffer.data(), buffer.size(), 0);
  if (count < 0) return errno == EAGAIN || errno == EINTR;
  if (count == 0) return false;
  if (connection.phase == Phase::lingering) return true;
  connection.received.append(buffer.data(), static_cast<std::size_t>(count));
  return advance(connection);
}

/// Sees how far the request has come. @return whether the connection stays here
bool Reception::advance(Connection& connection) {
  if (connection.phase == Phase::idle) {
    connection.phase = Phase::head;
    connection.deadline = Clock::now() + limits_.head_time;
  }
  try {
    if (connection.phase == Phase::head) {
      const std::size_t end = connection.received.substr(0, limits_.head_bytes).find(end_of_head);
      if (end != std::string::npos) return begin_body(connection, end + end_of_head.size());
      if (connection.received.size() >= limits_.head_bytes) {
        const bool first_line = connection.received.find("\r\n") == std::string::npos;
        throw Refused({first_line ? 414 : 431, fmt::format("a request's head may have {} bytes", limits_.head_bytes)});
      }
      return true;
    }
  } catch (const Refused& refused) {
    return refuse(connection, refused.problem());
  }
  const std::size_t length = connection.head.content_length;
  if (connection.received.size() < length) return true;
  Arrival arrival{std::move(connection), {}};
  arrival.body = arrival.connection.received.substr(0, length);
  arrival.connection.received.erase(0, length);
  ++away_;
  on_arrival_(std::move(arrival));
  return false;
}

bool Reception::begin_body(Connection& connection, std::size_t head_size) {
  connection.head = parse_head(std::string_view(connection.received).substr(0, head_size), limits_);
  admit(connection.head, admission_);
  connection.received.erase(0, head_size);
  connection.phase = Phase::body;
  connection.deadline = Clock::now() + limits_.body_time;
  if (connection.head.expects_continue && connection.received.empty()) {
    send_now(connection.socket.get(), "HTTP/1.1 100 Continue\r\n\r\n");
  }
  return advance(connection);
}

bool Reception::refuse(Connection& connection, const Problem& problem) {
  on_refusal_(problem.status);
  send_now(connection.socket.get(), problem_response(problem));
  linger(connection);
  return true;
}

bool Reception::on_deadline(Connection& connection) {
  if (connection.phase == Phase::idle || connection.phase == Phase::lingering) return false;
  return refuse(connection, {408, connection.phase == Phase::head ? "the request's head took too long to come"
                                                                  : "the request's body took too long to come"});
}

}  // namespace steerstat
