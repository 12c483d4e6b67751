#pragma once

// What the kernel's sources include before they open their instruction set's namespace.

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <type_traits>

#include "control/cycle.hpp"
#include "core/elementary.hpp"
#include "integrate/lockstep_engine.hpp"
