#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <stop_token>
#include <string>

#include "core/instruction_set.hpp"
#include "distributed/message_bytes.hpp"
#include "distributed/ranks.hpp"

namespace steerstat {

/// What ranks are asked to work on.
struct Job {
  std::string spec;           ///< canonical
  std::string directory;      ///< where each writes what it finishes, on a file system that all share; "": nowhere
  bool send_outcomes{false};  ///< whether outcomes go to the leader

  [[nodiscard]] MessageWriter message() const {
    return MessageWriter{}.put(spec).put(directory).put(std::uint8_t{send_outcomes});
  }
  static Job read(std::span<const std::byte> bytes) {
    MessageReader reader(bytes);
    Job job;
    job.spec = reader.get_text();
    job.directory = reader.get_text();
    job.send_outcomes = reader.get<std::uint8_t>() != 0;
    return job;
  }
};

/// What a rank says when it begins: MessageKind::ready.
struct Readiness {
  std::uint32_t threads{1};
  InstructionSet simd{InstructionSet::portable};
};

/// What a rank says of a range: MessageKind::finished. The outcomes follow where they are asked for.
struct FinishedRange {
  std::uint64_t begin{0};
  std::uint64_t count{0};  ///< trials finished from the begin on: fewer than dealt where the rank was interrupted
  double wall_s{0.0};
};

/// How a rank works.
struct WorkOptions {
  unsigned threads{0};  ///< 0: one a core
  InstructionSet simd{best_instruction_set()};
  std::stop_token stop{};  ///< a request ends the rank's work after the blocks in flight
};

/// Works on the next job that the leader sends, on this rank, until it is over. Says what fails to the leader alone.
void work_on_next_job(Ranks& ranks, const WorkOptions& options);

/// Works on the jobs that the leader sends, one after the other, until the leader ends it.
/// @return the exit code that the leader sent
int work(Ranks& ranks, const WorkOptions& options);

}  // namespace steerstat
