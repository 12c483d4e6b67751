#include "hardening/problem.hpp"

#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

namespace steerstat {
namespace {

struct Phrase {
  int status;
  std::string_view text;
};

constexpr std::array<Phrase, 24> phrases{{{200, "OK"},
                                          {400, "Bad Request"},
                                          {401, "Unauthorized"},
                                          {403, "Forbidden"},
                                          {404, "Not Found"},
                                          {405, "Method Not Allowed"},
                                          {406, "Not Acceptable"},
                                          {408, "Request Timeout"},
                                          {409, "Conflict"},
                                          {411, "Length Required"},
                                          {413, "Content Too Large"},
                                          {414, "URI Too Long"},
                                          {415, "Unsupported Media Type"},
                                          {416, "Range Not Satisfiable"},
                                          {417, "Expectation Failed"},
                                          {421, "Misdirected Request"},
                                          {422, "Unprocessable Content"},
                                          {429, "Too Many Requests"},
                                          {431, "Request Header Fields Too Large"},
                                          {500, "Internal Server Error"},
                                          {501, "Not Implemented"},
                                          {503, "Service Unavailable"},
                                          {505, "HTTP Version Not Supported"},
                                          {507, "Insufficient Storage"}}};

}  // namespace

std::string phrase_of(int status) {
  for (const Phrase& phrase : phrases) {
    if (phrase.status == status) return std::string(phrase.text);
  }
  return "";
}

std::string problem_json(const Problem& problem) {
  nlohmann::ordered_json json{{"type", "about:blank"},
                              {"title", phrase_of(problem.status)},
                              {"status", problem.status},
                              {"detail", problem.detail}};
  if (!problem.errors.empty()) {
    nlohmann::ordered_json& errors = json["errors"] = nlohmann::ordered_json::array();
    for (const SpecError& error : problem.errors) {
      errors.push_back({{"pointer", error.pointer}, {"detail", error.detail}});
    }
  }
  // What a client sent may be quoted in it, and need not be UTF-8.
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace steerstat
