#include "statistics/slope.hpp"

#include <numeric>
#include <stdexcept>

namespace steerstat {

double least_squares_slope(std::span<const double> x, std::span<const double> y) {
  if (x.size() != y.size() || x.empty()) throw std::invalid_argument("least_squares_slope: needs pairs");
  const auto n = static_cast<double>(x.size());
  const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n;
  const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double squares = 0.0;
  double products = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    squares += (x[i] - mean_x) * (x[i] - mean_x);
    products += (x[i] - mean_x) * (y[i] - mean_y);
  }
  if (!(squares > 0.0)) throw std::invalid_argument("least_squares_slope: needs two different x");
  return products / squares;
}

}  // namespace steerstat
