#pragma once

#include <deque>
#include <mutex>
#include <utility>
#include <vector>

#include "distributed/ranks.hpp"

namespace steerstat::testing {

/// What ranks that are threads of one process send through.
class Mailboxes {
 public:
  explicit Mailboxes(int ranks) : boxes_(static_cast<std::size_t>(ranks) + 1) {}

  void put(std::size_t box, Message message) {
    const std::lock_guard lock(mutex_);
    boxes_[box].push_back(std::move(message));
  }

  std::optional<Message> next(std::size_t box) {
    const std::lock_guard lock(mutex_);
    if (boxes_[box].empty()) return std::nullopt;
    Message message = std::move(boxes_[box].front());
    boxes_[box].pop_front();
    return message;
  }

  [[nodiscard]] int ranks() const { return static_cast<int>(boxes_.size()) - 1; }

 private:
  std::mutex mutex_;
  std::vector<std::deque<Message>> boxes_;  // of the workers by rank, and of the leader
};

class ThreadRanks final : public Ranks {
 public:
  ThreadRanks(Mailboxes& boxes, int rank) : boxes_(boxes), rank_(rank) {}

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int count() const override { return boxes_.ranks(); }
  void send_to_worker(int rank, MessageKind kind, std::span<const std::byte> bytes) override {
    boxes_.put(static_cast<std::size_t>(rank), {rank_, kind, {bytes.begin(), bytes.end()}});
  }
  void send_to_leader(MessageKind kind, std::span<const std::byte> bytes) override {
    boxes_.put(static_cast<std::size_t>(boxes_.ranks()), {rank_, kind, {bytes.begin(), bytes.end()}});
  }
  std::optional<Message> next_for_worker() override { return boxes_.next(static_cast<std::size_t>(rank_)); }
  std::optional<Message> next_for_leader() override { return boxes_.next(static_cast<std::size_t>(boxes_.ranks())); }

 private:
  Mailboxes& boxes_;
  const int rank_;
};

}  // namespace steerstat::testing
