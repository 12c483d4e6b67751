#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace steerstat {

/// The correlation of two of a list's variables; pairs that are not mentioned are uncorrelated.
struct PairCorrelation {
  std::size_t first;
  std::size_t second;
  double correlation;  ///< in (-1, 1)
};

/// Lower triangular factor L of a correlation matrix R = L L^T.
struct CorrelationFactor {
  std::size_t size;
  std::vector<double> elements;  ///< (size x size), row by row

  [[nodiscard]] double at(std::size_t row, std::size_t column) const { return elements[row * size + column]; }
};

/// A correlation matrix counts as positive definite where every variable keeps at least this part of its variance when
/// those before it are given; below, the difference from 0 would be a matter of rounding.
inline constexpr double least_conditional_variance = 1e-12;

/// The Cholesky factor of a correlation matrix. The same bits on every machine: sums run in one order.
///
/// @param size          number of variables
/// @param correlations  no pair twice
/// @return nothing where the matrix is not positive definite.
std::optional<CorrelationFactor> factorise_correlation(std::size_t size, std::span<const PairCorrelation> correlations);

/// Which variables contradict one another, where a correlation matrix is not positive definite: a set of them whose
/// matrix is not, and of which none can be left out. Increasing.
std::vector<std::size_t> contradicting_variables(std::size_t size, std::span<const PairCorrelation> correlations);

}  // namespace steerstat
