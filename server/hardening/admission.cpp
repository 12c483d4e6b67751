#include "hardening/admission.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <string_view>

#include "hardening/lower_case.hpp"
#include "hardening/token.hpp"

namespace steerstat {
namespace {

/// The name of `name:port` or `[address]:port`; "" where it is neither.
std::string name_of_authority(std::string_view authority) {
  std::string_view port;
  std::string_view name;
  if (!authority.empty() && authority.front() == '[') {
    const std::size_t end = authority.find(']');
    if (end == std::string_view::npos) return "";
    name = authority.substr(1, end - 1);
    port = authority.substr(end + 1);
  } else {
    const std::size_t colon = std::min(authority.find(':'), authority.size());
    name = authority.substr(0, colon);
    port = authority.substr(colon);
  }
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (!port.empty() && (port.front() != ':' || !std::all_of(port.begin() + 1, port.end(), is_digit))) return "";
  return lower_case(name);
}

bool is_address(const std::string& name) {
  unsigned char bytes[16];
  return inet_pton(AF_INET, name.c_str(), bytes) == 1 || inet_pton(AF_INET6, name.c_str(), bytes) == 1;
}

/// `authority` without the port that its scheme has anyway.
std::string without_default_port(std::string authority, std::string_view port) {
  if (authority.size() > port.size() && authority.compare(authority.size() - port.size(), port.size(), port) == 0) {
    authority.resize(authority.size() - port.size());
  }
  return authority;
}

bool is_same_origin(std::string_view origin, std::string_view host) {
  const auto matches = [&](std::string_view scheme, std::string_view port) {
    return origin.substr(0, scheme.size()) == scheme &&
           without_default_port(lower_case(origin.substr(scheme.size())), port) ==
               without_default_port(lower_case(host), port);
  };
  return matches("http://", ":80") || matches("https://", ":443");
}

bool answers_to(const std::string& name, const Admission& admission) {
  if (name.empty()) return false;
  if (std::find(admission.hosts.begin(), admission.hosts.end(), name) != admission.hosts.end()) return true;
  return admission.any_address && is_address(name);
}

}  // namespace

bool is_loopback(const std::string& address) {
  in_addr four{};
  if (inet_pton(AF_INET, address.c_str(), &four) == 1) return (ntohl(four.s_addr) >> 24U) == 127;
  in6_addr six{};
  return inet_pton(AF_INET6, address.c_str(), &six) == 1 && IN6_IS_ADDR_LOOPBACK(&six);
}

void admit(const RequestHead& head, const Admission& admission) {
  // An HTTP/1.0 request need not name a host; a browser's always does.
  if (head.has("host") && !answers_to(name_of_authority(head.field("host")), admission)) {
    throw Refused({421, "the service does not answer to this Host; use its address, or start it with --allow-host"});
  }
  if (head.has("origin") && !is_same_origin(head.field("origin"), head.field("host"))) {
    throw Refused({403, "requests from other sites' pages are refused (Origin)"});
  }
  const bool navigates = head.field("sec-fetch-mode") == "navigate" && head.method == "GET";
  if (head.field("sec-fetch-site") == "cross-site" && !navigates) {
    throw Refused({403, "requests from other sites' pages are refused (Sec-Fetch-Site)"});
  }
  const std::string_view path = std::string_view(head.target).substr(0, head.target.find('?'));
  if (admission.token && path != "/healthz" && !shows_token(head.field("authorization"), *admission.token)) {
    Problem problem{401, "show the service's token: `Authorization: Bearer TOKEN`, or as a password of any user"};
    problem.headers = {{"WWW-Authenticate", "Bearer realm=\"steerstat\""},
                       {"WWW-Authenticate", "Basic realm=\"steerstat\""}};
    throw Refused(std::move(problem));
  }
}

}  // namespace steerstat
