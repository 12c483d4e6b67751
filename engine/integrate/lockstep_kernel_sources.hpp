// The kernel, after a pack; see core/instruction_set.hpp. Each part needs those before it, whence the blank lines.

#include "core/pack_elementary.hpp"

#include "integrate/lockstep_series.hpp"

#include "integrate/lockstep_lanes.hpp"

#include "integrate/lockstep_quiet.hpp"

#include "integrate/lockstep_step.hpp"

#include "integrate/lockstep_motion.hpp"

#include "integrate/lockstep_guards.hpp"

#include "integrate/lockstep_roots.hpp"

#include "integrate/lockstep_packed_engine.hpp"

#include "integrate/lockstep_exertion.hpp"

#include "integrate/lockstep_kernel.hpp"

#include "integrate/lockstep_imperfect_series.hpp"

#include "integrate/lockstep_imperfect_lanes.hpp"

#include "integrate/lockstep_imperfect_kernel.hpp"

namespace steerstat::STEERSTAT_ISA {

template <bool measured>
LockstepEngine* make_kernel(double tolerance) {
  // Where single precision's rounding is well below what the tolerance lets a step truncate; see Expansion.
  constexpr double finest_mixed = 5e-10;
  if (tolerance >= finest_mixed) return new Kernel<mixed, measured>(tolerance);
  return new Kernel<full, measured>(tolerance);
}

LockstepEngine* make_kernel(double tolerance, bool measured) {
  return measured ? make_kernel<true>(tolerance) : make_kernel<false>(tolerance);
}

LockstepEngine* make_imperfect_kernel(double tolerance) {
  return new ImperfectKernel(tolerance);
}

}  // namespace steerstat::STEERSTAT_ISA
