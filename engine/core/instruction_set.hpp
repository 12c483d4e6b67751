#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace steerstat {

/// The instruction sets the lockstep engine is built for, best first.
///
/// One source serves all: a source NAME_avx512.cpp defines STEERSTAT_ISA as avx512, includes that pack and then the
/// kernel, whose code lands in namespace steerstat::avx512; it is compiled with that set's flags, and must define no
/// symbol outside that namespace, lest the linker give another source's caller code its machine cannot run.
enum class InstructionSet : std::uint8_t { avx512 = 0, avx2 = 1, portable = 2 };

inline constexpr std::array<std::string_view, 3> instruction_set_names{"avx512", "avx2", "portable"};

constexpr std::string_view name_of(InstructionSet set) {
  return instruction_set_names[static_cast<std::size_t>(set)];
}

/// @return the instruction set called `name`, or nothing where there is none.
constexpr std::optional<InstructionSet> instruction_set_named(std::string_view name) {
  for (std::size_t i = 0; i < instruction_set_names.size(); ++i) {
    if (instruction_set_names[i] == name) return static_cast<InstructionSet>(i);
  }
  return std::nullopt;
}

/// Whether this machine (and this build) can run `set`.
bool supports(InstructionSet set);

/// The best instruction set this machine can run.
InstructionSet best_instruction_set();

}  // namespace steerstat
