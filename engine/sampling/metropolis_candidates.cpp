#include "sampling/metropolis_candidates.hpp"

#include <algorithm>

#include "core/elementary.hpp"
#include "core/normal.hpp"
#include "sampling/normal_probability.hpp"

namespace steerstat {

MetropolisCandidates::MetropolisCandidates(std::uint64_t seed, std::span<const std::string> names) {
  streams_.reserve(names.size());
  for (const std::string& name : names) streams_.emplace_back(seed, name + " in a chain");
}

void MetropolisCandidates::place(std::uint64_t index, std::span<const double> state,
                                 std::span<double> candidate) const {
  constexpr double least = 0x1p-53;  // the nearest to 0 and 1 that designs draw
  for (std::size_t i = 0; i < state.size(); ++i) {
    const auto block = streams_[i].at(index);
    const double step = unit_interval((std::uint64_t{block[1]} << 32U) | block[0]);
    const double chance = unit_interval((std::uint64_t{block[3]} << 32U) | block[2]);
    const double z = normal_quantile(state[i]);
    const double moved = z + reach * (2.0 * step - 1.0);
    const bool moves = chance < exponential(0.5 * (z * z - moved * moved));  // the ratio of the densities
    candidate[i] = moves ? std::clamp(quick_normal_probability(moved), least, 1.0 - least) : state[i];
  }
}

}  // namespace steerstat
