#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.hpp"

namespace steerstat {

/// Why a request is not answered as asked [RFC 9457]. A value; throw it as Refused.
struct Problem {
  int status{500};                                             ///< of the response, 4xx or 5xx
  std::string detail;                                          ///< what is wrong and what to do, for people
  std::vector<SpecError> errors{};                             ///< mistakes by place in the document that was sent
  std::vector<std::pair<std::string, std::string>> headers{};  ///< that the response has besides
};

/// The phrase of a status, "Not Found"; "" for one that is never sent.
std::string phrase_of(int status);

/// The media type of problem_json().
inline constexpr const char* problem_type = "application/problem+json";

/// The problem as `{"type", "title", "status", "detail"}`, with `errors` where there are any; ends in a newline.
std::string problem_json(const Problem& problem);

/// A problem on its way to the client.
class Refused : public std::exception {
 public:
  explicit Refused(Problem problem) : problem_(std::move(problem)) {}
  [[nodiscard]] const Problem& problem() const { return problem_; }
  [[nodiscard]] const char* what() const noexcept override { return problem_.detail.c_str(); }

 private:
  Problem problem_;
};

}  // namespace steerstat
