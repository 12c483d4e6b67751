#include "integrate/lockstep_engine.hpp"

#include "core/errors.hpp"

namespace steerstat {

// One a source lockstep_NAME.cpp; the caller owns the result.
#if defined(__x86_64__)
namespace avx512 {
LockstepEngine* make_kernel(double tolerance);
LockstepEngine* make_imperfect_kernel(double tolerance);
}  // namespace avx512
namespace avx2 {
LockstepEngine* make_kernel(double tolerance);
LockstepEngine* make_imperfect_kernel(double tolerance);
}  // namespace avx2
#endif
namespace portable {
LockstepEngine* make_kernel(double tolerance);
LockstepEngine* make_imperfect_kernel(double tolerance);
}  // namespace portable

std::unique_ptr<LockstepEngine> make_lockstep_engine(double tolerance, InstructionSet set, LoopKind kind) {
  const auto make = [&](auto ideal, auto imperfect) {
    return std::unique_ptr<LockstepEngine>(kind == LoopKind::ideal ? ideal(tolerance) : imperfect(tolerance));
  };
  if (supports(set)) {
    switch (set) {
#if defined(__x86_64__)
      case InstructionSet::avx512:
        return make(avx512::make_kernel, avx512::make_imperfect_kernel);
      case InstructionSet::avx2:
        return make(avx2::make_kernel, avx2::make_imperfect_kernel);
#endif
      case InstructionSet::portable:
        return make(portable::make_kernel, portable::make_imperfect_kernel);
      default:
        break;
    }
  }
  throw BadUsage("this machine does not run the instruction set " + std::string(name_of(set)));
}

}  // namespace steerstat
