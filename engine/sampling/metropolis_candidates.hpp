#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sampling/stream.hpp"

namespace steerstat {

/// Candidates of Markov chains whose states are distributed as independent uniform coordinates: the component-wise
/// ("modified") Metropolis algorithm [Au and Beck 2001], in the standard normal variables behind the coordinates. Each
/// variable moves by a uniform step of at most `reach` to either side, or stays, with the probability that keeps its
/// distribution; a candidate outside of the set that a chain is held to is the caller's to refuse.
///
/// Candidate i is a pure function of seed, names, i and the state it comes from. Immutable and thread-safe.
class MetropolisCandidates {
 public:
  static constexpr double reach = 1.0;  ///< [standard deviations]; the width that [Au and Beck 2001] use

  MetropolisCandidates(std::uint64_t seed, std::span<const std::string> names);

  /// @param state      (variables) in (0, 1)
  /// @param candidate  (variables) written; coordinates that stay keep their bits
  void place(std::uint64_t index, std::span<const double> state, std::span<double> candidate) const;

 private:
  std::vector<BlockStream> streams_;  // one a variable
};

}  // namespace steerstat
