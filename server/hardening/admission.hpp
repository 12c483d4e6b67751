#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hardening/request_head.hpp"

namespace steerstat {

/// Who may come in.
struct Admission {
  std::vector<std::string> hosts;    ///< names, in lower case and without port, that the service answers to
  bool any_address{false};           ///< answers to any IP address too
  std::optional<std::string> token;  ///< that clients must show, /healthz apart; nothing: none is asked for
};

/// Whether an address is of this machine alone: 127.0.0.0/8 or ::1. @param address  as numbers
bool is_loopback(const std::string& address);

/// Turns away who does not belong. Pure and thread-safe.
///
/// - A name that is not ours in Host: a page of that name, pointed at this address by its owner's DNS, would else be of
///   one origin with us. IP addresses cannot be so pointed.
/// - An Origin other than the Host: another site's page, which could else have a user's browser POST and DELETE.
/// - No token, or a wrong one.
///
/// @throws Refused 421, 403, 401
void admit(const RequestHead& head, const Admission& admission);

}  // namespace steerstat
