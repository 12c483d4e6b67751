#pragma once

namespace steerstat {

/// What the program tells its caller on exit.
enum class ExitCode : int {
  done = 0,
  check_failed = 1,   ///< the run went well, but a gate failed: its figures are not what was asked for
  bad_request = 2,    ///< bad usage or a bad spec; nothing was run or written
  inconclusive = 3,   ///< a gate was inconclusive, and none failed
  run_failed = 4,     ///< I/O, a corrupt file, or a bug
  interrupted = 130,  ///< by SIGINT or SIGTERM, with what was finished kept
};

}  // namespace steerstat
