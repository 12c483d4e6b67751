#include "integrate/lockstep_includes.hpp"

#define STEERSTAT_ISA avx512
#include "core/pack_avx512.hpp"
#include "integrate/lockstep_kernel_sources.hpp"
