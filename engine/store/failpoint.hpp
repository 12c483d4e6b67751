#pragma once

namespace steerstat {

/// The two sides of a step that writes to a disk.
enum class Moment { before, after };

#ifdef STEERSTAT_FAILPOINTS

/// Where tests make a step of writing fail, or the process die. They ask for it in the environment variable
/// STEERSTAT_FAILPOINT, `MOMENT-STEP:N:ACTION`, such as `before-rename:3:kill`: the N-th time that the process comes
/// there, it is killed (kill), or the step fails with EIO (error) or ENOSPC (full). Built only with the tests.
/// Thread-safe.
///
/// @param step  close, fsync, rename, directory-fsync
/// @return the error that the step fails with; 0 where it goes on
int failpoint(Moment moment, const char* step);

#else

inline int failpoint(Moment /*moment*/, const char* /*step*/) {
  return 0;
}

#endif

}  // namespace steerstat
