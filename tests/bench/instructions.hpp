#pragma once

namespace steerstat::bench {

/// Runs 300 trials of the combined study in lockstep on AVX2, for `tests/bench/run instructions` to count the
/// instructions of LockstepRunner::run, and prints how many trials that were. Valgrind runs no AVX-512.
///
/// @throws BadUsage where this machine does not run AVX2
void run_to_be_counted();

}  // namespace steerstat::bench
