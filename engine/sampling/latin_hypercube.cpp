#include "sampling/latin_hypercube.hpp"

#include <bit>
#include <cmath>

namespace steerstat {

// With this many bits, stratum + place is exact in a double, and its quotient by n rounds to nothing nearer to the
// stratum's bounds than a quarter of the smallest place: no draw changes its stratum, none is 0 or 1.
LatinHypercube::LatinHypercube(std::uint64_t draws, std::uint64_t seed, std::span<const std::string> names)
    : draws_(static_cast<double>(draws)),
      place_bits_(51U - static_cast<unsigned>(std::bit_width(draws))),
      place_size_(std::ldexp(1.0, -static_cast<int>(place_bits_))) {
  variables_.reserve(names.size());
  for (const std::string& name : names) {
    const std::string purpose = "latin_hypercube " + std::to_string(draws) + ' ' + name;
    variables_.push_back({Permutation(draws, seed, purpose + " strata"), BlockStream(seed, purpose + " places")});
  }
}

double LatinHypercube::coordinate(std::uint64_t draw, std::size_t variable) const {
  const auto stratum = static_cast<double>(variables_[variable].strata.at(draw));
  const auto block = variables_[variable].places.at(draw);
  const std::uint64_t bits = ((std::uint64_t{block[1]} << 32U) | block[0]) >> (64U - place_bits_);
  return (stratum + (static_cast<double>(bits) + 0.5) * place_size_) / draws_;
}

}  // namespace steerstat
