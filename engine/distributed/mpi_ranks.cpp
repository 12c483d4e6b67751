#include <mpi.h>

#include <cstdlib>
#include <string>

#include "core/errors.hpp"
#include "distributed/ranks.hpp"

namespace steerstat {
namespace {

/// Messages one way. MPI itself ends all processes where something fails.
class Way {
 public:
  Way() { MPI_Comm_dup(MPI_COMM_WORLD, &communicator_); }
  ~Way() { MPI_Comm_free(&communicator_); }
  Way(const Way&) = delete;
  Way& operator=(const Way&) = delete;

  void send(int rank, MessageKind kind, std::span<const std::byte> bytes) const {
    MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, rank, static_cast<int>(kind), communicator_);
  }

  [[nodiscard]] std::optional<Message> next() const {
    int there = 0;
    MPI_Status status{};
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, communicator_, &there, &status);
    if (there == 0) return std::nullopt;
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    Message message{status.MPI_SOURCE, static_cast<MessageKind>(status.MPI_TAG),
                    std::vector<std::byte>(static_cast<std::size_t>(size))};
    MPI_Recv(message.bytes.data(), size, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, communicator_, MPI_STATUS_IGNORE);
    return message;
  }

 private:
  MPI_Comm communicator_{MPI_COMM_NULL};
};

class MpiRanks final : public Ranks {
 public:
  MpiRanks() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
    to_workers_.emplace();
    to_leader_.emplace();
  }
  ~MpiRanks() override {
    to_leader_.reset();
    to_workers_.reset();
    MPI_Finalize();
  }
  MpiRanks(const MpiRanks&) = delete;
  MpiRanks& operator=(const MpiRanks&) = delete;

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int count() const override { return count_; }
  void send_to_worker(int rank, MessageKind kind, std::span<const std::byte> bytes) override {
    to_workers_->send(rank, kind, bytes);
  }
  void send_to_leader(MessageKind kind, std::span<const std::byte> bytes) override { to_leader_->send(0, kind, bytes); }
  std::optional<Message> next_for_worker() override { return to_workers_->next(); }
  std::optional<Message> next_for_leader() override { return to_leader_->next(); }

 private:
  int rank_{0};
  int count_{1};
  std::optional<Way> to_workers_;
  std::optional<Way> to_leader_;
};

}  // namespace

std::optional<int> rank_in_environment() {
  // Open MPI's mpirun sets both, srun --mpi=pmix the second. Only these start processes that find each other.
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK"}) {
    const char* const rank = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
    if (rank != nullptr) return static_cast<int>(std::strtol(rank, nullptr, 10));
  }
  return std::nullopt;
}

std::unique_ptr<Ranks> join_ranks() {
  if (!rank_in_environment()) return nullptr;
  int provided = MPI_THREAD_SINGLE;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_MULTIPLE, &provided);
  if (provided < MPI_THREAD_MULTIPLE) {
    MPI_Finalize();
    throw RunFailure("this MPI does not let several threads send (MPI_THREAD_MULTIPLE); use one that does");
  }
  auto ranks = std::make_unique<MpiRanks>();
  if (ranks->count() == 1) return nullptr;
  return ranks;
}

}  // namespace steerstat
