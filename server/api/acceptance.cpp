#include "api/acceptance.hpp"

#include <algorithm>
#include <string>

namespace steerstat {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
  const std::size_t end = text.find_last_not_of(" \t") + 1;
  return begin < end ? text.substr(begin, end - begin) : std::string_view{};
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

/// Takes what stands before the next separator, trimmed.
std::string_view next_part(std::string_view& text, char separator) {
  const std::size_t end = std::min(text.find(separator), text.size());
  const std::string_view part = trimmed(text.substr(0, end));
  text.remove_prefix(std::min(end + 1, text.size()));
  return part;
}

/// Whether the parameters of a range say `q=0`.
bool is_refusal(std::string_view parameters) {
  while (!parameters.empty()) {
    const std::string parameter = lower(next_part(parameters, ';'));
    if (!parameter.starts_with("q=")) continue;
    const std::string_view quality = std::string_view(parameter).substr(2);
    return !quality.empty() && quality.find_first_not_of("0.") == std::string_view::npos;
  }
  return false;
}

/// How much of a type a range names: 3 the type itself, 2 `application/*`, 1 `*/*`, 0 another one.
int specificity(const std::string& range, std::string_view type) {
  if (range == type) return 3;
  if (range == "*/*") return 1;
  const std::string_view family = type.substr(0, type.find('/') + 1);
  return range.size() == family.size() + 1 && range.starts_with(family) && range.back() == '*' ? 2 : 0;
}

}  // namespace

bool accepts(std::string_view accept, std::string_view type) {
  if (trimmed(accept).empty()) return true;
  int most = 0;
  bool accepted = false;
  while (!accept.empty()) {
    std::string_view parameters = next_part(accept, ',');
    const std::string range = lower(next_part(parameters, ';'));
    const int here = specificity(range, type);
    if (here <= most) continue;
    most = here;
    accepted = !is_refusal(parameters);
  }
  return accepted;
}

}  // namespace steerstat
