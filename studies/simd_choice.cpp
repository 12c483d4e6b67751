#include "simd_choice.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/errors.hpp"

namespace steerstat {
namespace {

/// The instruction sets that the lockstep engine has kernels for in this build.
std::span<const InstructionSet> built_in() {
#if defined(__x86_64__)
  static constexpr std::array sets{InstructionSet::avx512, InstructionSet::avx2, InstructionSet::portable};
#else
  static constexpr std::array sets{InstructionSet::portable};
#endif
  return sets;
}

std::string names_of(std::span<const InstructionSet> sets) {
  std::vector<std::string_view> names;
  for (const InstructionSet set : sets) names.push_back(name_of(set));
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string names_run_here() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set : built_in()) {
    if (supports(set)) sets.push_back(set);
  }
  return names_of(sets);
}

}  // namespace

InstructionSet choose_simd(const std::string& name) {
  const std::optional<InstructionSet> set = instruction_set_named(name);
  if (!set) {
    throw BadUsage(
        fmt::format("--simd: there is no instruction set '{}'; this machine runs {}", name, names_run_here()));
  }
  if (!supports(*set)) {
    throw BadUsage(fmt::format("--simd: this machine does not run {}; it runs {}", name, names_run_here()));
  }
  return *set;
}

std::string simd_text() {
  return fmt::format("lockstep built for {}; {} here", names_of(built_in()), name_of(best_instruction_set()));
}

}  // namespace steerstat
