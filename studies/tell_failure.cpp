#include "tell_failure.hpp"

#include <fmt/format.h>

#include <exception>
#include <new>

#include "core/errors.hpp"
#include "output.hpp"

namespace steerstat {

ExitCode tell_failure() noexcept {
  try {
    throw;
  } catch (const BadUsage& bad) {
    tell(bad.what());
    return ExitCode::bad_request;
  } catch (const BadSpec& bad) {
    tell(bad.what());
    return ExitCode::bad_request;
  } catch (const ReaderGone&) {
    // Its reader knows; nothing to say.
  } catch (const RunFailure& failure) {
    tell(failure.what());
  } catch (const std::bad_alloc&) {
    tell_raw("steerstat: out of memory; use fewer trials, cells or retained trajectories\n");
  } catch (const std::exception& bug) {
    tell(fmt::format("a bug ended the run ({}); please report it with the command and the spec", bug.what()));
  } catch (...) {
    tell_raw("steerstat: a bug ended the run; please report it with the command and the spec\n");
  }
  return ExitCode::run_failed;
}

}  // namespace steerstat
