#include "sampling/factorial.hpp"

namespace steerstat {

Factorial::Factorial(const std::vector<std::size_t>& levels) : factors_(levels.size()) {
  for (std::size_t i = levels.size(); i-- > 0;) {
    factors_[i] = {levels[i], cells_};
    cells_ *= levels[i];
  }
}

}  // namespace steerstat
