#include "core/instruction_set.hpp"

namespace steerstat {

// What is asked here is what cmake/Kernel.cmake compiles for.
bool supports(InstructionSet set) {
#if defined(__x86_64__)
  switch (set) {
    case InstructionSet::avx512:
      return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
             __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
             supports(InstructionSet::avx2);
    case InstructionSet::avx2:
      return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0 &&
             __builtin_cpu_supports("bmi2") != 0;
    case InstructionSet::portable:
      return true;
  }
  return false;
#else
  return set == InstructionSet::portable;
#endif
}

InstructionSet best_instruction_set() {
  if (supports(InstructionSet::avx512)) return InstructionSet::avx512;
  if (supports(InstructionSet::avx2)) return InstructionSet::avx2;
  return InstructionSet::portable;
}

}  // namespace steerstat
