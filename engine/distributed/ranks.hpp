#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace steerstat {

/// What a message between ranks is. Those that lead() sends come first.
enum class MessageKind : std::uint8_t {
  job,       ///< a study to work on
  range,     ///< trials to run
  over,      ///< of the job: no more trials
  end,       ///< of the process: its exit code
  ready,     ///< for a range
  progress,  ///< trials finished of the range under way
  finished,  ///< trials of the range
  failed,    ///< the rank works no more, and why
};

struct Message {
  int from{0};  ///< rank
  MessageKind kind{MessageKind::over};
  std::vector<std::byte> bytes;
};

/// The processes that run a study together. Rank 0 leads, on its own thread, and works like all others on another.
///
/// Messages to the leader and messages to workers go separate ways, so that rank 0 can send to itself. Each way keeps
/// the order of those from one rank. Sending is thread-safe; each way is received by one thread of a process.
class Ranks {
 public:
  Ranks() = default;
  virtual ~Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int count() const = 0;

  virtual void send_to_worker(int rank, MessageKind kind, std::span<const std::byte> bytes) = 0;
  virtual void send_to_leader(MessageKind kind, std::span<const std::byte> bytes) = 0;

  /// The next message; nothing where none has come. Does not wait.
  virtual std::optional<Message> next_for_worker() = 0;
  virtual std::optional<Message> next_for_leader() = 0;
};

/// Joins the processes that mpirun or srun started with this one.
/// @return null where it started alone, or where this build knows no MPI
/// @throws RunFailure where MPI does not let several threads send
std::unique_ptr<Ranks> join_ranks();

/// This process's rank, before it joins: as whatever started it says. Nothing where join_ranks() gives null.
std::optional<int> rank_in_environment();

}  // namespace steerstat
