#pragma once

#include <cstddef>
#include <functional>

namespace steerstat {

/// Runs `task` for every number below the first argument, on several threads or on one.
using ForEach = std::function<void(std::size_t, const std::function<void(std::size_t)>&)>;

}  // namespace steerstat
