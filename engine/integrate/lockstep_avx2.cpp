#include "integrate/lockstep_includes.hpp"

#define STEERSTAT_ISA avx2
#include "core/pack_avx2.hpp"
#include "integrate/lockstep_kernel_sources.hpp"
