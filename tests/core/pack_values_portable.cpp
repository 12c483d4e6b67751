#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "core/elementary.hpp"

#define STEERSTAT_ISA portable
#include "core/pack_portable.hpp"
#include "pack_values_source.hpp"
