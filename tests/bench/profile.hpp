#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace steerstat::bench {

/// Samples by function of this program, demangled; those in shared libraries under "shared libraries".
using Profile = std::map<std::string, std::uint64_t>;

/// Runs `work` on this thread, noting a thousand times a second which function it is in. A function that was inlined
/// counts for the one it was inlined into. Not reentrant.
///
/// @throws RunFailure where the timer cannot be set or the program's symbols cannot be read
Profile profile(const std::function<void()>& work);

}  // namespace steerstat::bench
