// The kernel, after a pack; see core/instruction_set.hpp. Each part needs those before it, whence the blank lines.

#include "core/pack_elementary.hpp"

#include "integrate/lockstep_series.hpp"

#include "integrate/lockstep_lanes.hpp"

#include "integrate/lockstep_guards.hpp"

#include "integrate/lockstep_kernel.hpp"

namespace steerstat::STEERSTAT_ISA {

LockstepEngine* make_kernel(double tolerance) {
  return new Kernel(tolerance);
}

}  // namespace steerstat::STEERSTAT_ISA
