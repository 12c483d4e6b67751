#include "store/failpoint.hpp"

#ifdef STEERSTAT_FAILPOINTS

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>
#include <string_view>

namespace steerstat {
namespace {

/// How often the place was come by that the variable's present value names.
struct Visits {
  std::string asked;
  unsigned count{0};
};

/// What comes before the next colon; `text` keeps what comes after it.
std::string_view take_word(std::string_view& text) {
  const std::size_t end = std::min(text.find(':'), text.size());
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return word;
}

/// A typing mistake in a test must not pass for a step that did not fail.
[[noreturn]] void refuse(std::string_view asked) {
  static_cast<void>(std::fprintf(stderr, "STEERSTAT_FAILPOINT: '%.*s' is not MOMENT-STEP:N:ACTION\n",
                                 static_cast<int>(asked.size()), asked.data()));
  std::abort();
}

}  // namespace

int failpoint(Moment moment, const char* step) {
  const char* const value = std::getenv("STEERSTAT_FAILPOINT");  // NOLINT(concurrency-mt-unsafe): set before threads
  if (value == nullptr || *value == '\0') return 0;
  std::string_view rest = value;
  const std::string_view place = take_word(rest);
  const std::string_view number = take_word(rest);
  unsigned wanted = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), wanted);
  if (error != std::errc() || end != number.data() + number.size()) refuse(value);
  const bool dies = rest == "kill";
  if (!dies && rest != "error" && rest != "full") refuse(value);
  if (place != std::string(moment == Moment::before ? "before-" : "after-") + step) return 0;

  static std::mutex mutex;
  static Visits visits;
  const std::lock_guard lock(mutex);
  if (visits.asked != value) visits = {value, 0};
  if (++visits.count != wanted) return 0;
  if (dies) static_cast<void>(std::raise(SIGKILL));
  return rest == "full" ? ENOSPC : EIO;
}

}  // namespace steerstat

#endif
