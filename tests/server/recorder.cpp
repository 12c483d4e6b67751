#include "recorder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <mutex>

namespace steerstat::testing {
namespace {

std::mutex recording;
std::map<std::uint16_t, Answerer> recorded_ports;

/// Bytes as a JSON string of as many characters.
std::string quoted(const std::string& bytes) {
  std::string text = "\"";
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f && c != '"' && c != '\\') {
      text += c;
      continue;
    }
    std::array<char, 8> escaped{};
    std::snprintf(escaped.data(), escaped.size(), "\\u%04x", byte);
    text += escaped.data();
  }
  return text + '"';
}

std::string line_of(Answerer answerer, const std::string& request, const RawResponse& response) {
  const std::size_t first = request.find(' ');
  const std::string method = request.substr(0, first);
  const std::string target = request.substr(first + 1, request.find_first_of(" \r\n", first + 1) - first - 1);
  return std::string("{\"answerer\":\"") + (answerer == Answerer::service ? "service" : "door") +
         "\",\"method\":" + quoted(method) + ",\"target\":" + quoted(target) +
         ",\"status\":" + std::to_string(response.status) + ",\"head\":" + quoted(response.head) +
         ",\"body\":" + quoted(response.body) + "}\n";
}

}  // namespace

void record_answers(std::uint16_t port, Answerer answerer) {
  const std::lock_guard lock(recording);
  recorded_ports[port] = answerer;
}

void note_answer(std::uint16_t port, const std::string& request, const RawResponse& response) {
  const char* const directory = std::getenv("STEERSTAT_ANSWERS");
  const std::lock_guard lock(recording);
  const auto known = recorded_ports.find(port);
  if (directory == nullptr || known == recorded_ports.end()) return;
  if (response.status < (known->second == Answerer::door ? 400 : 100)) return;
  const std::string path = std::string(directory) + "/raw-" + std::to_string(getpid()) + ".jsonl";
  const std::string line = line_of(known->second, request, response);
  const FileDescriptor file(open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600));
  if (write(file.get(), line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
    std::perror(path.c_str());  // a record that is not whole fails the check of it
  }
}

}  // namespace steerstat::testing
