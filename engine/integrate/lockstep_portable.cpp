#include "integrate/lockstep_includes.hpp"

#define STEERSTAT_ISA portable
#include "core/pack_portable.hpp"
#include "integrate/lockstep_kernel_sources.hpp"
