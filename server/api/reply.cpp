#include "api/reply.hpp"

#include <fmt/format.h>
#include <httplib.h>

namespace steerstat {

std::string tag_of(std::uint64_t revision) {
  return fmt::format("\"{}\"", revision);
}

bool has_already(const httplib::Request& request, httplib::Response& response, const std::string& tag) {
  const auto [first, last] = request.headers.equal_range("If-None-Match");
  for (auto field = first; field != last; ++field) {
    // A tag has neither commas nor quotes in it, so a list of them has it where it has its text.
    const std::string& list = field->second;
    if (list != "*" && list.find(tag) == std::string::npos) continue;
    response.status = 304;
    response.set_header("ETag", tag);
    response.set_header("Cache-Control", "no-cache");
    return true;
  }
  return false;
}

void reply_json(httplib::Response& response, std::string_view json, const std::string& tag, int status) {
  response.status = status;
  if (!tag.empty()) response.set_header("ETag", tag);
  response.set_header("Cache-Control", "no-cache");
  response.set_content(json.data(), json.size(), "application/json");
}

void secure(httplib::Response& response) {
  const auto add = [&response](const char* name, const char* value) {
    if (!response.has_header(name)) response.set_header(name, value);
  };
  add("X-Content-Type-Options", "nosniff");
  add("Referrer-Policy", "no-referrer");
  add("Cross-Origin-Resource-Policy", "same-origin");
  add("Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'");
}

}  // namespace steerstat
