#include "integrate/lockstep_engine.hpp"

#include <utility>

#include "control/cycle.hpp"
#include "core/errors.hpp"
#include "integrate/exertion_meter.hpp"
#include "integrate/lane_output.hpp"
#include "integrate/metered_engine.hpp"

namespace steerstat {

// One a source lockstep_NAME.cpp; the caller owns the result.
#if defined(__x86_64__)
namespace avx512 {
LockstepEngine* make_kernel(double tolerance, bool measured);
LockstepEngine* make_imperfect_kernel(double tolerance);
}  // namespace avx512
namespace avx2 {
LockstepEngine* make_kernel(double tolerance, bool measured);
LockstepEngine* make_imperfect_kernel(double tolerance);
}  // namespace avx2
#endif
namespace portable {
LockstepEngine* make_kernel(double tolerance, bool measured);
LockstepEngine* make_imperfect_kernel(double tolerance);
}  // namespace portable

void LockstepEngine::set_exertion(int, const Exertion&) {}

Exertion LockstepEngine::exertion(int) const {
  return {};
}

void LockstepEngine::meter(const ClosedLoop<double>& loop, const Phase& phase, double start, double from, double to,
                           int lane, Exertion& exertion) const {
  ExertionMeter(loop, phase, start, exertion).step(from, to, LaneOutput(*this, lane));
}

double LockstepEngine::peak_of_cycle(const Phase& cycle, double t) {
  return cycle_peak_acceleration(cycle.amplitude, cycle.duration, t);
}

std::unique_ptr<LockstepEngine> make_lockstep_engine(double tolerance, InstructionSet set, LoopKind kind,
                                                     bool measured) {
  const auto make = [&](auto ideal, auto imperfect) {
    if (kind == LoopKind::ideal) return std::unique_ptr<LockstepEngine>(ideal(tolerance, measured));
    std::unique_ptr<LockstepEngine> engine(imperfect(tolerance));
    if (measured) engine = std::make_unique<MeteredEngine>(std::move(engine));
    return engine;
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
