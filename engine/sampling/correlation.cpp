#include "sampling/correlation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <numeric>

namespace steerstat {
namespace {

using Matrix = Eigen::MatrixXd;

Matrix correlation_matrix(std::size_t size, std::span<const PairCorrelation> correlations) {
  const auto n = static_cast<Eigen::Index>(size);
  Matrix matrix = Matrix::Identity(n, n);
  for (const PairCorrelation& pair : correlations) {
    const auto i = static_cast<Eigen::Index>(pair.first);
    const auto j = static_cast<Eigen::Index>(pair.second);
    matrix(i, j) = matrix(j, i) = pair.correlation;
  }
  return matrix;
}

// L, or nothing where the matrix is not positive definite.
std::optional<Matrix> factor_of(const Matrix& matrix) {
  const Eigen::LLT<Matrix> cholesky(matrix);
  if (cholesky.info() != Eigen::Success) return std::nullopt;
  Matrix lower = cholesky.matrixL();
  if ((lower.diagonal().array().square() < least_conditional_variance).any()) return std::nullopt;
  return lower;
}

}  // namespace

std::optional<CorrelationFactor> factorise_correlation(std::size_t size,
                                                       std::span<const PairCorrelation> correlations) {
  const auto lower = factor_of(correlation_matrix(size, correlations));
  if (!lower) return std::nullopt;
  CorrelationFactor factor{size, {}};
  factor.elements.reserve(size * size);
  for (Eigen::Index i = 0; i < lower->rows(); ++i) {
    for (Eigen::Index j = 0; j < lower->cols(); ++j) factor.elements.push_back((*lower)(i, j));
  }
  return factor;
}

std::vector<std::size_t> contradicting_variables(std::size_t size, std::span<const PairCorrelation> correlations) {
  const Matrix matrix = correlation_matrix(size, correlations);
  std::vector<std::size_t> left(size);
  std::iota(left.begin(), left.end(), std::size_t{0});
  for (std::size_t candidate = 0; candidate < size; ++candidate) {
    std::vector<std::size_t> without;
    std::copy_if(left.begin(), left.end(), std::back_inserter(without),
                 [&](std::size_t variable) { return variable != candidate; });
    if (!factor_of(matrix(without, without))) left = std::move(without);
  }
  return left;
}

}  // namespace steerstat
