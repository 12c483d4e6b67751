#pragma once

#include <string>
#include <utility>

#include "hardening/http_server.hpp"
#include "recorder.hpp"

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
  OpenServer(DoorOptions options, Handler handler, Answerer answerer = Answerer::door)
      : HttpServer(std::move(options)) {
    record_answers(port(), answerer);
    open(std::move(handler));
  }
};

}  // namespace steerstat::testing
