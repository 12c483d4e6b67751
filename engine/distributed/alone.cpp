#include "distributed/ranks.hpp"

// A build that knows no MPI.
namespace steerstat {

std::unique_ptr<Ranks> join_ranks() {
  return nullptr;
}

std::optional<int> rank_in_environment() {
  return std::nullopt;
}

}  // namespace steerstat
