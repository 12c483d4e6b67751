#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

#include "../service/service_fixture.hpp"
#include "api/api.hpp"
#include "json_text.hpp"
#include "open_server.hpp"
#include "raw_client.hpp"

namespace steerstat::testing {

using Json = nlohmann::ordered_json;

inline std::string read_file(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

class ApiCase : public ServiceCase {
 protected:
  ApiCase() { reopen({}); }
  ~ApiCase() override {
    if (api) api->stop();
    server.reset();
  }

  void reopen(ApiOptions options) {
    if (api) api->stop();
    server.reset();
    api = std::make_unique<Api>(*service, std::move(options));
    server = std::make_unique<OpenServer>(
        at_free_port(), [this](const auto& question, auto& answer) { api->answer(question, answer); },
        Answerer::service);
    port = server->port();
  }

  RawResponse get(const std::string& target, const std::string& fields = "") const {
    return ask(port, request("GET", target, fields));
  }
  RawResponse post(const std::string& target, const std::string& body,
                   const std::string& type = "application/json") const {
    return ask(port, request("POST", target, "Content-Type: " + type + "\r\n", body));
  }
  /// Submits a spec. @return its id
  std::string submit(const std::string& spec) const {
    return ordered_json_of(post("/v1/studies", spec).body).at("id").get<std::string>();
  }
  /// Submits a quick study and waits for its end. @return where it is
  std::string finished(std::uint64_t trials = 50) {
    const std::string id = submit(quick_spec(trials));
    wait_for_end(id);
    return "/v1/studies/" + id;
  }

  std::unique_ptr<Api> api;
  std::unique_ptr<OpenServer> server;
  std::uint16_t port{0};
};

}  // namespace steerstat::testing
