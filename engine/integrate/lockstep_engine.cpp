#include "integrate/lockstep_engine.hpp"

#include "core/errors.hpp"

namespace steerstat {

// One a source lockstep_NAME.cpp; the caller owns the result.
#if defined(__x86_64__)
namespace avx512 {
LockstepEngine* make_kernel(double tolerance);
}
namespace avx2 {
LockstepEngine* make_kernel(double tolerance);
}
#endif
namespace portable {
LockstepEngine* make_kernel(double tolerance);
}

std::unique_ptr<LockstepEngine> make_lockstep_engine(double tolerance, InstructionSet set) {
  if (supports(set)) {
    switch (set) {
#if defined(__x86_64__)
      case InstructionSet::avx512:
        return std::unique_ptr<LockstepEngine>(avx512::make_kernel(tolerance));
      case InstructionSet::avx2:
        return std::unique_ptr<LockstepEngine>(avx2::make_kernel(tolerance));
#endif
      case InstructionSet::portable:
        return std::unique_ptr<LockstepEngine>(portable::make_kernel(tolerance));
      default:
        break;
    }
  }
  throw BadUsage("this machine does not run the instruction set " + std::string(name_of(set)));
}

}  // namespace steerstat
