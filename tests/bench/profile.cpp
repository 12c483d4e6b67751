#include "profile.hpp"

#include <signal.h>
#include <sys/syscall.h>
#include <time.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstddef>

#include "core/errors.hpp"
#include "symbols.hpp"

namespace steerstat::bench {
namespace {

constexpr std::size_t most_samples = 200'000;
std::array<std::uintptr_t, most_samples> samples;
std::atomic<std::size_t> taken{0};

void take_sample(int, siginfo_t*, void* context) {
  const std::size_t i = taken.load(std::memory_order_relaxed);
  if (i == most_samples) return;
  samples[i] = static_cast<std::uintptr_t>(static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_RIP]);
  taken.store(i + 1, std::memory_order_relaxed);
}

/// Interrupts this thread a thousand times a second while it lives.
class Sampler {
 public:
  Sampler() {
    struct sigaction action {};
    action.sa_sigaction = take_sample;
    action.sa_flags = SA_SIGINFO | SA_RESTART;
    sigevent event{};
    event.sigev_notify = SIGEV_THREAD_ID;
    event.sigev_signo = SIGPROF;
    event._sigev_un._tid = static_cast<pid_t>(syscall(SYS_gettid));
    // By wall time: timers of CPU time tick as coarsely as the scheduler.
    const itimerspec period{{0, 1'000'000}, {0, 1'000'000}};
    if (sigaction(SIGPROF, &action, nullptr) != 0 || timer_create(CLOCK_MONOTONIC, &event, &timer_) != 0) {
      throw RunFailure("cannot set a timer to sample with");
    }
    timer_settime(timer_, 0, &period, nullptr);
  }
  ~Sampler() { timer_delete(timer_); }
  Sampler(const Sampler&) = delete;
  Sampler& operator=(const Sampler&) = delete;

 private:
  timer_t timer_{};
};

}  // namespace

Profile profile(const std::function<void()>& work) {
  const Symbols symbols;
  taken.store(0);
  {
    const Sampler sampler;
    work();
  }
  Profile counts;
  for (std::size_t i = 0; i < taken.load(); ++i) ++counts[symbols.name_at(samples[i])];
  return counts;
}

}  // namespace steerstat::bench
