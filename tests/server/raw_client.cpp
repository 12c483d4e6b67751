#include "raw_client.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "recorder.hpp"

namespace steerstat::testing {

std::string RawResponse::field(const std::string& name) const {
  const std::size_t at = head.find("\r\n" + name + ": ");
  if (at == std::string::npos) return "";
  const std::size_t begin = at + name.size() + 4;
  return head.substr(begin, head.find("\r\n", begin) - begin);
}

RawClient::RawClient(std::uint16_t port) : port_(port), socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    throw std::system_error(errno, std::generic_category(), "connect");
  }
}

RawClient::~RawClient() {
  const std::size_t end = streamed_.find("\r\n\r\n");
  if (end == std::string::npos) return;
  const int status = std::atoi(streamed_.c_str() + 9);
  note_answer(port_, sent_, {status, streamed_.substr(0, end + 2), streamed_.substr(end + 4)});
}

/// The first request of those that are not answered.
std::string RawClient::take_request() {
  const std::size_t end = sent_.find("\r\n\r\n");
  if (end == std::string::npos) return std::exchange(sent_, {});
  const RawResponse head{0, sent_.substr(0, end + 2), {}};
  const std::size_t length = std::strtoul(head.field("Content-Length").c_str(), nullptr, 10);
  std::string request = sent_.substr(0, end + 4 + std::min(length, sent_.size()));
  sent_.erase(0, request.size());
  return request;
}

bool RawClient::send(const std::string& bytes) {
  sent_ += bytes;
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::send(socket_.get(), bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
    if (count < 0 && errno != EINTR) return false;
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  return true;
}

void RawClient::end() {
  shutdown(socket_.get(), SHUT_WR);
}

bool RawClient::fill(std::chrono::steady_clock::time_point end) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now()).count();
  pollfd wait{socket_.get(), POLLIN, 0};
  if (left <= 0 || poll(&wait, 1, static_cast<int>(left)) <= 0) return false;
  std::array<char, 65536> buffer;
  const ssize_t count = recv(socket_.get(), buffer.data(), buffer.size(), 0);
  if (count <= 0) return false;
  received_.append(buffer.data(), static_cast<std::size_t>(count));
  return true;
}

RawResponse RawClient::receive(bool head_only, std::chrono::milliseconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  RawResponse response;
  std::size_t head_end = 0;
  while ((head_end = received_.find("\r\n\r\n")) == std::string::npos) {
    if (!fill(end)) return response;
  }
  response.head = received_.substr(0, head_end + 2);
  received_.erase(0, head_end + 4);
  response.status = std::atoi(response.head.c_str() + 9);
  const std::string length = response.field("Content-Length");
  const std::size_t size = length.empty() || head_only ? 0 : std::stoul(length);
  while (received_.size() < size && fill(end)) {
  }
  response.body = received_.substr(0, size);
  received_.erase(0, size);
  note_answer(port_, response.status == 100 ? sent_ : take_request(), response);
  return response;
}

std::string RawClient::receive_until(const std::string& text, std::chrono::milliseconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  std::size_t at = 0;
  while ((at = received_.find(text)) == std::string::npos) {
    if (!fill(end)) break;
  }
  const std::size_t size = at == std::string::npos ? received_.size() : at + text.size();
  std::string result = received_.substr(0, size);
  received_.erase(0, size);
  streamed_ += result;
  return result;
}

bool RawClient::is_closed(std::chrono::milliseconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (fill(end)) {
  }
  pollfd wait{socket_.get(), POLLIN, 0};
  char byte = 0;
  return received_.empty() && poll(&wait, 1, 0) == 1 && recv(socket_.get(), &byte, 1, MSG_DONTWAIT) == 0;
}

RawResponse ask(std::uint16_t port, const std::string& bytes) {
  RawClient client(port);
  client.send(bytes);
  return client.receive(bytes.starts_with("HEAD "));
}

std::string request(const std::string& method, const std::string& target, const std::string& fields,
                    const std::string& body) {
  std::string text = method + " " + target + " HTTP/1.1\r\nHost: localhost\r\n" + fields;
  if (method == "POST") text += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  return text + "\r\n" + body;
}

}  // namespace steerstat::testing
