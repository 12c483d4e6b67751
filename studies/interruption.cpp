#include "interruption.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <system_error>

#include "core/errors.hpp"

namespace steerstat {
namespace {

constexpr char interrupted_byte = 'i';
constexpr char finished_byte = 'f';

// The handler's only way out. A stop_source locks and allocates, so the handler may not touch it: it writes a byte, and
// a thread that waits for the byte requests the stop.
std::atomic<int> write_end{-1};
static_assert(std::atomic<int>::is_always_lock_free);

void set_action(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

void write_byte(char byte) {
  while (write(write_end.load(), &byte, 1) < 0 && errno == EINTR) {
  }
}

void on_signal(int /*signal*/) {
  const int saved = errno;
  set_action(SIGINT, SIG_DFL);  // the next one ends the process
  set_action(SIGTERM, SIG_DFL);
  write_byte(interrupted_byte);
  errno = saved;
}

}  // namespace

Interruption::Interruption() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    throw RunFailure("cannot listen for signals (" + std::generic_category().message(errno) + ")");
  }
  read_end_ = ends[0];
  write_end = ends[1];
  listener_ = std::thread([this] {
    char byte = finished_byte;
    for (;;) {
      const ssize_t count = read(read_end_, &byte, 1);
      if (count < 0 && errno == EINTR) continue;
      if (count != 1 || byte == finished_byte) return;
      stop_.request_stop();
    }
  });
  set_action(SIGINT, on_signal);
  set_action(SIGTERM, on_signal);
}

Interruption::~Interruption() {
  set_action(SIGINT, SIG_DFL);
  set_action(SIGTERM, SIG_DFL);
  write_byte(finished_byte);
  listener_.join();
  close(read_end_);
  close(write_end.exchange(-1));
}

}  // namespace steerstat
