#include "service/study_runner.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "service/kept_run.hpp"

namespace steerstat {
namespace {

/// [bytes] of memory of the machine.
std::uint64_t machine_memory() {
  const long pages = ::sysconf(_SC_PHYS_PAGES);
  const long page = ::sysconf(_SC_PAGESIZE);
  if (pages <= 0 || page <= 0) return std::uint64_t{4} << 30U;
  return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page);
}

}  // namespace

StudyRunner::StudyRunner(Catalogue& catalogue, unsigned threads, const ServiceLimits& limits, Tell tell,
                         std::optional<Launcher> launcher)
    : catalogue_(catalogue),
      threads_(threads),
      limits_(limits),
      memory_(limits.memory > 0 ? limits.memory : machine_memory() / 2),
      tell_(std::move(tell)),
      launcher_(std::move(launcher)),
      turns_(threads),
      workers_(static_cast<unsigned>(threads * std::max<std::size_t>(limits.running_studies, 1))) {}

StudyRunner::~StudyRunner() {
  stop();
}

void StudyRunner::start() {
  dispatcher_ = std::thread([this] { dispatch(); });
}

void StudyRunner::enqueue(const Catalogue::Entry& entry) {
  const std::lock_guard lock(mutex_);
  queue_.push_back({entry, 0});
  wake_.notify_all();
}

bool StudyRunner::withdraw(const StudyEntry& entry) {
  const std::lock_guard lock(mutex_);
  return std::erase_if(queue_, [&](const Waiting& waiting) { return waiting.entry.get() == &entry; }) > 0;
}

std::size_t StudyRunner::queued() const {
  const std::lock_guard lock(mutex_);
  return queue_.size();
}

void StudyRunner::stop() {
  {
    const std::lock_guard lock(mutex_);
    if (!stopping_) stopping_until_ = StudyEntry::Clock::now() + limits_.stopping_time;
    stopping_ = true;
    for (const Running& running : running_) {
      catalogue_.look(*running.entry, [](const StudyEntry& entry) {
        if (entry.run) std::stop_source(entry.run->stop).request_stop();
      });
    }
    wake_.notify_all();
  }
  if (dispatcher_.joinable()) dispatcher_.join();
}

void StudyRunner::dispatch() {
  constexpr std::chrono::milliseconds interval{200};  // between looks at how long studies run
  std::unique_lock lock(mutex_);
  while (!stopping_ || !running_.empty()) {
    reap();
    while (!stopping_ && begin_next()) {
    }
    stop_overtime();
    give_up_overdue();
    keep_records(lock);
    if (stopping_ && running_.empty()) break;
    const auto has_news = [&] {
      return std::any_of(running_.begin(), running_.end(), [](const Running& one) { return one.has_ended; });
    };
    if (has_news()) continue;
    if (running_.empty() && unkept_.empty()) {
      wake_.wait(lock, [&] { return stopping_ || !queue_.empty(); });
    } else {
      wake_.wait_for(lock, interval);
    }
  }
}

/// Begins the next study that fits. @return whether there was one
bool StudyRunner::begin_next() {
  std::vector<WaitingStudy> waiting;
  for (const Waiting& one : queue_) waiting.push_back({one.entry->demand, one.overtaken});
  std::vector<StudyDemand> running;
  for (const Running& one : running_) running.push_back(one.entry->demand);
  const std::optional<std::size_t> chosen = next_to_begin(waiting, running, limits_, memory_);
  if (!chosen) return false;
  const auto place = queue_.begin() + static_cast<std::ptrdiff_t>(*chosen);
  for (auto earlier = queue_.begin(); earlier != place; ++earlier) ++earlier->overtaken;
  Running& next = running_.emplace_back(Running{place->entry});
  queue_.erase(place);
  catalogue_.change(*next.entry, [&](StudyEntry& entry) {
    entry.run = StudyEntry::Run{};
    entry.run->threads = threads_;
    if (!entry.record.started) entry.record.started = utc_now();
  });
  try {
    next.thread = std::thread([this, &next] { run(next); });
  } catch (const std::system_error& no_thread) {
    catalogue_.change(*next.entry, [](StudyEntry& entry) { entry.run.reset(); });
    tell_(fmt::format("cannot begin study {} ({}); it is tried again", next.entry->id, no_thread.what()));
    queue_.push_front({next.entry, 0});
    running_.pop_back();
    return false;
  }
  return true;
}

void StudyRunner::reap() {
  for (auto one = running_.begin(); one != running_.end();) {
    if (!one->has_ended) {
      ++one;
      continue;
    }
    one->thread.join();  // it does nothing after the mark
    one = running_.erase(one);
  }
}

void StudyRunner::stop_overtime() {
  for (const Running& running : running_) {
    const bool is_overtime = catalogue_.look(*running.entry, [&](const StudyEntry& entry) {
      return entry.run && !entry.run->is_overtime && StudyEntry::Clock::now() - entry.run->began >= limits_.wall_time;
    });
    if (!is_overtime) continue;
    catalogue_.change(*running.entry, [this](StudyEntry& entry) {
      if (!entry.run) return;
      entry.run->is_overtime = true;
      entry.run->given_up_at = StudyEntry::Clock::now() + limits_.ending_time;
      entry.run->stop.request_stop();
    });
  }
}

/// Gives up the blocks in flight of runs that should have ended by now.
void StudyRunner::give_up_overdue() {
  const auto now = StudyEntry::Clock::now();
  for (const Running& running : running_) {
    catalogue_.look(*running.entry, [&](const StudyEntry& entry) {
      if (!entry.run || now < std::min(entry.run->given_up_at, stopping_until_)) return;
      std::stop_source(entry.run->give_up).request_stop();
    });
  }
}

/// Writes the records that could not be written, if they can be now.
void StudyRunner::keep_records(std::unique_lock<std::mutex>& lock) {
  constexpr std::chrono::seconds interval{1};
  if (unkept_.empty() || StudyEntry::Clock::now() < next_keeping_) return;
  std::vector<Catalogue::Entry> waiting = std::exchange(unkept_, {});
  lock.unlock();
  std::erase_if(waiting, [&](const Catalogue::Entry& entry) {
    if (catalogue_.find(entry->id) != entry) return true;  // it has been removed
    try {
      keep_record(catalogue_, *entry);
    } catch (const std::exception&) {
      return false;  // why has been told
    }
    tell_(fmt::format("how study {} ended is on the disk now", entry->id));
    return true;
  });
  lock.lock();
  unkept_.insert(unkept_.end(), waiting.begin(), waiting.end());
  next_keeping_ = StudyEntry::Clock::now() + interval;
}

void StudyRunner::run(Running& running) {
  const bool is_kept =
      run_and_keep({catalogue_, *running.entry, threads_, turns_, limits_, tell_, trials_done_, launcher_});
  const std::lock_guard lock(mutex_);
  if (!is_kept) unkept_.push_back(running.entry);
  running.has_ended = true;
  wake_.notify_all();
}

}  // namespace steerstat
