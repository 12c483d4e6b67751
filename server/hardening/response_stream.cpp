#include "hardening/response_stream.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>

namespace steerstat {

using Clock = std::chrono::steady_clock;

ResponseStream::ResponseStream(int socket, std::string head, const DoorLimits& limits, const std::atomic<bool>& cut)
    : socket_(socket), head_(std::move(head)), limits_(limits), cut_(cut) {}

bool ResponseStream::is_writable() const {
  if (failed_ || cut_) return false;
  pollfd wait{socket_, POLLOUT | POLLRDHUP, 0};
  return poll(&wait, 1, 0) >= 0 && (wait.revents & (POLLERR | POLLHUP | POLLRDHUP | POLLNVAL)) == 0;
}

ssize_t ResponseStream::read(char* data, std::size_t size) {
  const std::size_t count = std::min(size, head_.size() - read_);
  std::memcpy(data, head_.data() + read_, count);
  read_ += count;
  return static_cast<ssize_t>(count);
}

/// Lets the client wait anew whenever it has taken a piece: a byte now and then is not enough.
void ResponseStream::count(std::size_t taken) {
  constexpr std::size_t piece = 64U << 10U;
  taken_ += taken;
  if (taken_ < piece) return;
  taken_ = 0;
  blocked_ = {};
}

ssize_t ResponseStream::write(const char* data, std::size_t size) {
  if (status_ == 0) look_at_head({data, size});
  std::size_t done = 0;
  while (done < size && !failed_) {
    const ssize_t sent = send(socket_, data + done, size - done, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent >= 0) {
      done += static_cast<std::size_t>(sent);
      count(static_cast<std::size_t>(sent));
      continue;
    }
    if (errno == EINTR) continue;
    const bool full = errno == EAGAIN || errno == EWOULDBLOCK;
    if (!full || cut_ || blocked_ >= limits_.write_time) {
      failed_ = true;
      break;
    }
    const Clock::time_point begin = Clock::now();
    pollfd wait{socket_, POLLOUT, 0};
    poll(&wait, 1, 100);
    blocked_ += Clock::now() - begin;
  }
  return failed_ ? -1 : static_cast<ssize_t>(size);
}

void ResponseStream::look_at_head(std::string_view text) {
  const std::string_view head = text.substr(0, text.find("\r\n\r\n"));
  status_ = 500;
  if (head.size() > 12) status_ = (head[9] - '0') * 100 + (head[10] - '0') * 10 + (head[11] - '0');
  framed_ = head.find("\r\nContent-Length: ") != std::string_view::npos || status_ == 204 || status_ == 304;
}

void ResponseStream::get_remote_ip_and_port(std::string& address, int& port) const {
  address.clear();  // of no interest to any handler
  port = 0;
}

void ResponseStream::get_local_ip_and_port(std::string& address, int& port) const {
  address.clear();
  port = 0;
}

}  // namespace steerstat
