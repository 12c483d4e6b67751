#include "output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <span>
#include <string>
#include <system_error>

#include "distributed/ranks.hpp"
#include "store/whole_file.hpp"

namespace steerstat {
namespace {

std::string reason(int error) {
  return std::generic_category().message(error);
}

/// Writes all of `text` to a descriptor. @return 0 or the error number
int write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = write(descriptor, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return 0;
}

/// @return the value of an environment variable, "" where it is not set
std::string_view environment(const char* name) {
  const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): nothing here sets the environment
  return value == nullptr ? std::string_view() : std::string_view(value);
}

bool is_terminal(StandardStream stream) {
  return isatty(static_cast<int>(stream)) == 1;
}

}  // namespace

void secure_standard_streams() {
  // open() takes the lowest free number, so going up fills each gap. Reading from what should be written to, and the
  // other way round, fails: the error is noticed where it matters.
  for (int descriptor = 0; descriptor <= 2; ++descriptor) {
    if (fcntl(descriptor, F_GETFD) == -1 && errno == EBADF) {
      if (open("/dev/null", descriptor == 0 ? O_WRONLY : O_RDONLY) != descriptor) std::_Exit(4);
    }
  }
  static_cast<void>(std::signal(SIGPIPE, SIG_IGN));  // fails for no signal that there is
}

void mute_standard_streams() {
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere < 0) return;
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  close(nowhere);
}

void print(std::string_view text) {
  const int error = write_all(STDOUT_FILENO, text);
  if (error == 0) return;
  const std::string message = "cannot write to standard output (" + reason(error) + ")";
  if (error == EPIPE) throw ReaderGone(message);
  throw RunFailure(message);
}

void tell_raw(std::string_view text) {
  write_all(STDERR_FILENO, text);
}

void tell(std::string_view message) {
  tell_raw(fmt::format("steerstat: {}\n", message));
}

void write_text(const std::filesystem::path& path, std::string_view text) {
  write_whole_file(path, {std::as_bytes(std::span(text))});
}

bool redraws_lines(StandardStream stream) {
  const std::string_view terminal = environment("TERM");
  return is_terminal(stream) && !terminal.empty() && terminal != "dumb";
}

bool wants_colour(StandardStream stream) {
  // Open MPI gives every rank a terminal, wherever what it says goes in the end.
  return redraws_lines(stream) && environment("NO_COLOR").empty() && !rank_in_environment();
}

unsigned terminal_columns() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  return 80;
}

}  // namespace steerstat
