#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "accuracy.hpp"
#include "workload.hpp"

namespace steerstat::bench {

/// A way to run the trials, to be timed beside others.
struct Contender {
  std::string name;
  double tolerance;
  MakeRunner make_runner;
  unsigned threads;
  Accuracy accuracy;
  std::uint64_t trials;  ///< in one repetition
};

/// Trials a second, medians over repetitions.
struct Rate {
  double by_wall;
  double by_cpu;  ///< trials a second of CPU time, of all threads
};

/// Times all contenders in turns, so that what else the machine does at a time slows none alone.
///
/// @return (contenders)
std::vector<Rate> measure_rates(const std::vector<Contender>& contenders, int repetitions);

/// How many trials take a contender about `seconds`, from two short runs of its own.
std::uint64_t trials_for(double seconds, const MakeRunner& make_runner, unsigned threads);

}  // namespace steerstat::bench
