#include "sampling/monte_carlo.hpp"

namespace steerstat {

MonteCarlo::MonteCarlo(std::uint64_t seed, std::span<const std::string> names) {
  streams_.reserve(names.size());
  for (const std::string& name : names) streams_.emplace_back(seed, name);
}

double MonteCarlo::coordinate(std::uint64_t draw, std::size_t variable) const {
  return streams_[variable].at(draw);
}

}  // namespace steerstat
