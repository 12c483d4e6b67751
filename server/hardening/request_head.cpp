#include "hardening/request_head.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "hardening/lower_case.hpp"

namespace steerstat {
namespace {

[[noreturn]] void refuse(int status, std::string detail) {
  throw Refused({status, std::move(detail)});
}

bool is_token_character(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
         std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
}

bool is_token(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_token_character);
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// Takes the next line, without its CRLF, off `text`.
std::string_view next_line(std::string_view& text) {
  const std::size_t end = text.find("\r\n");
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 2);
  return line;
}

void parse_request_line(std::string_view line, const DoorLimits& limits, RequestHead& head) {
  const std::size_t first = line.find(' ');
  const std::size_t last = line.rfind(' ');
  if (first == std::string_view::npos || first == last || !is_token(line.substr(0, first))) {
    refuse(400, "the first line is no request line (METHOD TARGET HTTP/1.1)");
  }
  head.method = line.substr(0, first);
  const std::string_view target = line.substr(first + 1, last - first - 1);
  const std::string_view version = line.substr(last + 1);
  if (version.substr(0, 5) == "HTTP/" && version != "HTTP/1.1" && version != "HTTP/1.0") {
    refuse(505, "only HTTP/1.1 and HTTP/1.0 are spoken here");
  }
  if (version.substr(0, 5) != "HTTP/") refuse(400, "the first line is no request line (METHOD TARGET HTTP/1.1)");
  head.http_1_0 = version == "HTTP/1.0";
  if (target.size() > limits.target_bytes) refuse(414, "the target is longer than any that leads somewhere here");
  const auto visible = [](char c) { return c > ' ' && c < '\x7f' && c != '#'; };
  if (target.empty() || target.front() != '/' || !std::all_of(target.begin(), target.end(), visible)) {
    refuse(400, "the target is no path of visible ASCII characters; percent-encode the others");
  }
  head.target = target;
}

void parse_fields(std::string_view text, const DoorLimits& limits, RequestHead& head) {
  for (;;) {
    const std::string_view line = next_line(text);
    if (line.empty()) return;
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || !is_token(line.substr(0, colon))) {
      refuse(400, "a header line is no `name: value` (names have no white space, lines are not folded)");
    }
    const std::string_view value = trimmed(line.substr(colon + 1));
    const auto control = [](char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == '\x7f'; };
    if (std::any_of(value.begin(), value.end(), control)) {
      refuse(400, "a header's value has control characters in it");
    }
    if (line.size() > limits.field_bytes) {
      refuse(431, "a header field may have " + std::to_string(limits.field_bytes) + " bytes");
    }
    if (head.fields.size() == limits.fields) refuse(431, "there are too many header fields");
    head.fields.emplace_back(lower_case(line.substr(0, colon)), value);
  }
}

/// Two of these, even alike ones, are two opinions on what the request is.
constexpr std::array<std::string_view, 13> single_fields{
    "host",          "content-length", "content-type",  "content-encoding", "transfer-encoding",
    "authorization", "origin",         "expect",        "if-range",         "last-event-id",
    "range",         "sec-fetch-site", "sec-fetch-mode"};

void check_duplicates(const RequestHead& head) {
  for (const std::string_view name : single_fields) {
    const auto same = [name](const auto& field) { return field.first == name; };
    if (std::count_if(head.fields.begin(), head.fields.end(), same) > 1) {
      refuse(400, "the header field " + std::string(name) + " is there more than once");
    }
  }
}

std::size_t content_length(const RequestHead& head, const DoorLimits& limits) {
  const std::string_view text = head.field("content-length");
  std::size_t length = 0;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (text.empty() || !std::all_of(text.begin(), text.end(), is_digit)) {
    refuse(400, "Content-Length is no number of bytes");
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), length);
  if (error != std::errc{} || length > limits.body_bytes) {
    refuse(413, "the body may have " + std::to_string(limits.body_bytes) + " bytes; send less");
  }
  return length;
}

void check_framing(const DoorLimits& limits, RequestHead& head) {
  if (head.has("transfer-encoding")) {
    refuse(411, "bodies are taken with a Content-Length alone, not in chunks (Transfer-Encoding); send it whole");
  }
  if (head.has("content-length")) {
    head.content_length = content_length(head, limits);
  } else if (head.method == "POST") {
    refuse(411, "a POST needs a Content-Length");
  }
  if (head.content_length > 0 && head.method != "POST") refuse(400, "a body is taken with POST alone");
  if (head.has("content-encoding") && lower_case(head.field("content-encoding")) != "identity") {
    Problem problem{415, "bodies are taken uncompressed (no Content-Encoding)"};
    problem.headers.emplace_back("Accept-Encoding", "identity");
    throw Refused(std::move(problem));
  }
  if (head.has("expect")) {
    if (lower_case(head.field("expect")) != "100-continue") refuse(417, "of expectations 100-continue alone is met");
    head.expects_continue = !head.http_1_0;
  }
}

/// Whether a comma-separated list has a word.
bool lists(std::string_view list, std::string_view word) {
  while (!list.empty()) {
    const std::size_t comma = std::min(list.find(','), list.size());
    if (lower_case(trimmed(list.substr(0, comma))) == word) return true;
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
  return false;
}

}  // namespace

std::string_view RequestHead::field(std::string_view name) const {
  for (const auto& [key, value] : fields) {
    if (key == name) return value;
  }
  return {};
}

bool RequestHead::has(std::string_view name) const {
  return std::any_of(fields.begin(), fields.end(), [name](const auto& field) { return field.first == name; });
}

RequestHead parse_head(std::string_view text, const DoorLimits& limits) {
  RequestHead head;
  parse_request_line(next_line(text), limits, head);
  parse_fields(text, limits, head);
  check_duplicates(head);
  if (!head.http_1_0 && !head.has("host")) refuse(400, "there is no Host header field");
  check_framing(limits, head);
  head.keeps_alive = !head.http_1_0 && !lists(head.field("connection"), "close");
  return head;
}

}  // namespace steerstat
