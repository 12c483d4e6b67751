#pragma once

#include <string>
#include <utility>

#include "hardening/http_server.hpp"

namespace steerstat::testing {

/// At a free port of 127.0.0.1.
inline DoorOptions at_free_port() {
  DoorOptions options;
  options.port = 0;
  return options;
}

/// Open from the start.
class OpenServer : public HttpServer {
 public:
  OpenServer(DoorOptions options, Handler handler) : HttpServer(std::move(options)) { open(std::move(handler)); }
};

}  // namespace steerstat::testing
