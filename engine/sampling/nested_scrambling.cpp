#include "sampling/nested_scrambling.hpp"

#include <string>

namespace steerstat {
namespace {

constexpr unsigned levels = 7;  // of a subtree
static_assert(SobolSequence::digits % levels == 0, "subtrees end where the sequence's digits do");
static_assert(NestedScrambling::digits - SobolSequence::digits <= 32, "one word gives the digits that follow");

using Subtree = std::array<std::uint32_t, 4>;

// Node 1 is the subtree's root, nodes 2 n and 2 n + 1 are below node n.
std::uint64_t bit_of(const Subtree& subtree, std::uint64_t node) {
  return (subtree[node / 32] >> (node % 32)) & 1U;
}

}  // namespace

NestedScrambling::NestedScrambling(std::uint64_t seed, std::string_view name)
    : subtrees_(seed, "nested_scrambling " + std::string(name)), root_(subtrees_.at(1)) {}

std::uint64_t NestedScrambling::scramble(std::uint64_t coordinate) const {
  // The leading digits, with a 1 before them: of all subtrees, no two have the same.
  const auto path = [&](unsigned length) {
    return (std::uint64_t{1} << length) | (coordinate >> (SobolSequence::digits - length));
  };
  std::uint64_t scrambled = 0;
  for (unsigned depth = 0; depth < SobolSequence::digits; depth += levels) {
    const Subtree subtree = depth == 0 ? root_ : subtrees_.at(path(depth));
    std::uint64_t node = 1;
    for (unsigned level = 1; level <= levels; ++level) {
      const std::uint64_t digit = path(depth + level) & 1U;
      scrambled = (scrambled << 1U) | (digit ^ bit_of(subtree, node));
      node = (node << 1U) | digit;
    }
  }
  constexpr unsigned rest = digits - SobolSequence::digits;
  return (scrambled << rest) | (subtrees_.at(path(SobolSequence::digits))[0] >> (32U - rest));
}

}  // namespace steerstat
