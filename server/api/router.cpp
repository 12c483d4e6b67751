#include "api/router.hpp"

#include <optional>

#include "hardening/problem.hpp"

namespace steerstat {
namespace {

std::vector<std::string> split(std::string_view path) {
  std::vector<std::string> segments;
  while (!path.empty()) {
    path.remove_prefix(1);  // the slash
    const std::size_t end = std::min(path.find('/'), path.size());
    segments.emplace_back(path.substr(0, end));
    path.remove_prefix(end);
  }
  return segments;
}

bool is_value(std::string_view segment) {
  return !segment.empty() && segment.front() == '{';
}

/// What stands where the pattern has names; nothing where the path is of another form.
std::optional<std::vector<std::string>> match(const std::vector<std::string>& pattern,
                                              const std::vector<std::string>& path) {
  if (pattern.size() != path.size()) return std::nullopt;
  std::vector<std::string> values;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (is_value(pattern[i])) {
      values.push_back(path[i]);
    } else if (pattern[i] != path[i]) {
      return std::nullopt;
    }
  }
  return values;
}

}  // namespace

void Router::add(const std::string& method, const std::string& pattern, Handler handler) {
  routes_.push_back({method, pattern, split(pattern), std::move(handler)});
}

Router::Match Router::find(std::string_view method, std::string_view path) const {
  const std::vector<std::string> segments = split(path);
  std::string allowed;
  for (const Route& route : routes_) {
    std::optional<std::vector<std::string>> values = match(route.segments, segments);
    if (!values) continue;
    if (route.method == (method == "HEAD" ? "GET" : method)) return {&route, std::move(*values)};
    allowed += (allowed.empty() ? "" : ", ") + (route.method == "GET" ? "GET, HEAD" : route.method);
  }
  if (allowed.empty()) throw Refused({404, "nothing is here; /openapi.json tells what is where", {}, {}});
  throw Refused({405, "the method is not one of " + allowed, {}, {{"Allow", allowed}}});
}

}  // namespace steerstat
