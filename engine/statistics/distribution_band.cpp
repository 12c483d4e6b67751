#include "statistics/distribution_band.hpp"

#include <cmath>
#include <stdexcept>

namespace steerstat {

double distribution_band(std::uint64_t n, double level) {
  if (n == 0) throw std::invalid_argument("a band needs at least one value");
  if (!(level > 0.0 && level < 1.0)) throw std::invalid_argument("a band's level lies in (0, 1)");
  return std::sqrt(std::log(2.0 / (1.0 - level)) / (2.0 * static_cast<double>(n)));
}

}  // namespace steerstat
