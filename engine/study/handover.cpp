#include "study/handover.hpp"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace steerstat {
namespace {

constexpr std::uint64_t enough_trials = std::uint64_t{1} << 16;   // to be handed over before the time has come
constexpr std::uint64_t most_delivered = std::uint64_t{1} << 20;  // at a time

}  // namespace

HandOver::HandOver(OutcomeSink& sink, std::span<const TrialRange> blocks, std::uint64_t block,
                   std::span<const TrialOutcome> outcomes, std::function<void()> on_failure)
    : sink_(sink),
      blocks_(blocks),
      block_(block),
      outcomes_(outcomes),
      on_failure_(std::move(on_failure)),
      unfinished_((outcomes.size() + block - 1) / block) {
  for (const TrialRange& piece : blocks_) unfinished_[piece.begin / block_] += piece.end - piece.begin;
  thread_ = std::jthread([this](const std::stop_token& stop) { work_until(stop); });
}

void HandOver::finish() {
  thread_.request_stop();
  thread_.join();
  if (failure_) std::rethrow_exception(failure_);
  find_finished();
  deliver({});
}

void HandOver::work_until(const std::stop_token& stop) {
  constexpr std::chrono::milliseconds interval{50};
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  try {
    while (!wake.wait_for(lock, stop, interval, [&] { return stop.stop_requested(); })) {
      find_finished();
      if (due()) deliver(stop);
    }
  } catch (...) {
    failure_ = std::current_exception();
    on_failure_();
  }
}

void HandOver::find_finished() {
  for (; found_ < blocks_.size(); ++found_) {
    const TrialRange& piece = blocks_[found_];
    if (unfinished_[piece.begin / block_].load(std::memory_order_acquire) != 0) return;
    waiting_ += piece.end - piece.begin;
  }
}

bool HandOver::due() const {
  constexpr std::chrono::duration<double> shortest{0.1};
  constexpr std::chrono::duration<double> longest{10.0};
  if (waiting_ == 0) return false;
  if (waiting_ >= enough_trials) return true;
  const Clock::time_point now = Clock::now();
  // In proportion to what a restart would cost, so that short runs lose little and long ones make few files.
  const auto patience = std::clamp<std::chrono::duration<double>>((now - start_) / 20.0, shortest, longest);
  return now - last_ >= patience;
}

void HandOver::deliver(const std::stop_token& stop) {
  while (delivered_ < found_ && !stop.stop_requested()) {
    TrialRange range{blocks_[delivered_].begin, blocks_[delivered_].begin};
    while (delivered_ < found_ && blocks_[delivered_].begin == range.end && range.end - range.begin < most_delivered) {
      range.end = blocks_[delivered_++].end;
    }
    sink_.take(range.begin, outcomes_.subspan(range.begin, range.end - range.begin));
    waiting_ -= range.end - range.begin;
    last_ = Clock::now();
  }
}

}  // namespace steerstat
