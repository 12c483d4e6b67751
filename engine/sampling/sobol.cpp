#include "sampling/sobol.hpp"

namespace steerstat {

Sobol::Sobol(std::uint64_t seed, std::span<const std::string> names) : sequence_(names.size()) {
  scramblings_.reserve(names.size());
  for (const std::string& name : names) scramblings_.emplace_back(seed, name);
}

double Sobol::coordinate(std::uint64_t draw, std::size_t variable) const {
  const std::uint64_t scrambled = scramblings_[variable].scramble(sequence_.at(draw, variable));
  return unit_interval(scrambled << (64U - NestedScrambling::digits));
}

}  // namespace steerstat
